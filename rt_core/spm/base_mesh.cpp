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

bool read_position(BitReader& reader, const ModelHeader& header, const BaseLayout& layout,
                   Vec3f& position_m) noexcept
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::uint32_t quanta = reader.read(layout.axis_bits[axis]);
        if (quanta > header.fields().extent_quanta[axis])
        {
            return false;
        }
        position_m[axis] = static_cast<float>(quanta) * header.quantum_m();
    }
    return true;
}

bool read_face(BitReader& reader, std::uint32_t vertices, const BaseLayout& layout,
               BaseFace& face) noexcept
{
    for (VertexId& corner : face.corners)
    {
        corner = {reader.read(layout.vertex_bits)};
        if (corner.value >= vertices)
        {
            return false;
        }
    }
    face.bucket = reader.read(layout.bucket_bits);
    face.error = static_cast<ErrorCode>(reader.read(8));
    return face.corners[0] != face.corners[1] && face.corners[1] != face.corners[2] &&
           face.corners[2] != face.corners[0];
}

} // namespace

Result<Done, SpmRefusal> parse_base_mesh(std::span<const std::byte> bytes,
                                         const ModelHeader& header, const BaseMesh& mesh) noexcept
{
    const ModelCounts counts = header.counts();
    TACTUS_ASSERT(mesh.positions_m.size() == counts.base_vertices);
    TACTUS_ASSERT(mesh.faces.size() == counts.base_faces);
    TACTUS_ASSERT(mesh.next.size() == counts.base_faces);
    const std::uint64_t size = coded_base_bytes(header.fields());
    if (bytes.size() != size)
    {
        return bytes.size() < size ? SpmRefusal::too_short : SpmRefusal::trailing_bytes;
    }
    const BaseLayout layout(header.fields());
    const auto content = bytes.first(bytes.size() - kChecksumBytes);
    if (ByteReader(bytes.last(kChecksumBytes)).read<std::uint32_t>() != crc32c(content))
    {
        return SpmRefusal::wrong_checksum;
    }
    BitReader reader(content);
    for (Vec3f& position_m : mesh.positions_m)
    {
        if (!read_position(reader, header, layout, position_m))
        {
            return SpmRefusal::value_out_of_range;
        }
    }
    for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    {
        if (!read_face(reader, counts.base_vertices, layout, mesh.faces[i]))
        {
            return SpmRefusal::id_out_of_range;
        }
        mesh.next[i] = mesh.faces[i].error == 0 ? kNextExact : kNextPending;
    }
    return Done{};
}

} // namespace tactus
