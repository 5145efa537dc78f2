// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/base_mesh.hpp"

#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"
#include "rt_core/spm/page.hpp"

namespace tactus
{

namespace
{

bool read_position(ByteReader& reader, const ModelHeader& header, Vec3f& position_m) noexcept
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto quanta = reader.read<std::uint32_t>();
        if (quanta > header.fields().extent_quanta[axis])
        {
            return false;
        }
        position_m[axis] = static_cast<float>(quanta) * header.quantum_m();
    }
    return true;
}

bool read_face(ByteReader& reader, std::uint32_t vertices, BaseFace& face) noexcept
{
    for (VertexId& corner : face.corners)
    {
        corner = {reader.read<std::uint32_t>()};
        if (corner.value >= vertices)
        {
            return false;
        }
    }
    face.bucket = reader.read<std::uint32_t>();
    face.error = reader.read<ErrorCode>();
    return face.corners[0] != face.corners[1] && face.corners[1] != face.corners[2] &&
           face.corners[2] != face.corners[0];
}

} // namespace

Result<Done, SpmRefusal> parse_base_mesh(std::span<const std::byte> bytes,
                                         const ModelHeader& header, const BaseMesh& mesh) noexcept
{
    const ModelCounts counts = header.counts();
    TACTUS_ASSERT(mesh.positions_m.size() == counts.base_vertices);
    TACTUS_ASSERT(mesh.faces.size() == counts.base_faces && mesh.next.size() == counts.base_faces);
    if (bytes.size() != coded_base_bytes(counts))
    {
        return bytes.size() < coded_base_bytes(counts) ? SpmRefusal::too_short
                                                       : SpmRefusal::trailing_bytes;
    }
    ByteReader reader(bytes);
    for (Vec3f& position_m : mesh.positions_m)
    {
        if (!read_position(reader, header, position_m))
        {
            return SpmRefusal::value_out_of_range;
        }
    }
    for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    {
        if (!read_face(reader, counts.base_vertices, mesh.faces[i]))
        {
            return SpmRefusal::id_out_of_range;
        }
        mesh.next[i] = mesh.faces[i].error == 0 ? kNextExact : kNextPending;
    }
    if (reader.read<std::uint32_t>() != crc32c(bytes.first(bytes.size() - kChecksumBytes)))
    {
        return SpmRefusal::wrong_checksum;
    }
    return Done{};
}

} // namespace tactus
