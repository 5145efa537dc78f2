// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/detail/gltf_mesh.hpp"

#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/scene/detail/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::detail
{

namespace
{

constexpr std::array<std::string_view, 7> kModes{
    "POINTS", "LINES", "LINE_LOOP", "LINE_STRIP", "TRIANGLES", "TRIANGLE_STRIP", "TRIANGLE_FAN"};
constexpr std::size_t kTriangles = 4;
constexpr std::size_t kStrip = 5;

/// To remember which vertex of the mesh an element became costs 4 bytes for each of the accessor.
constexpr std::uint64_t kElementsPerRead = 16;
constexpr std::uint32_t kUnseen = 0xFFFF'FFFF;

std::size_t mode_of(const JsonAt& primitive)
{
    const auto mode = primitive.find("mode");
    const std::size_t code = mode ? mode->index_below(kModes.size(), "modes") : kTriangles;
    if (code < kTriangles)
    {
        primitive.refuse(fmt::format("is made of {}; only triangles, strips and fans have a "
                                     "surface",
                                     kModes.at(code)));
    }
    return code;
}

/// What has a surface that this reader can't tell.
void refuse_what_moves(const GltfFile& file, const JsonAt& primitive)
{
    if (primitive.size_of("targets") > 0)
    {
        primitive.refuse("has morph targets; a model keeps its shape");
    }
    const auto extensions = primitive.find("extensions");
    if (extensions && extensions->find("KHR_draco_mesh_compression") &&
        file.requires_extension("KHR_draco_mesh_compression"))
    {
        primitive.refuse("is compressed with KHR_draco_mesh_compression, which is not supported");
    }
}

std::size_t accessor_of(const GltfFile& file, const JsonAt& json)
{
    return json.index_below(file.root().size_of("accessors"), "accessors");
}

std::size_t faces_of(std::size_t mode, std::size_t corners)
{
    return mode == kTriangles ? corners / 3 : corners - 2;
}

/// The places of a face's corners among those of its primitive, in the standard's order, which
/// keeps the winding.
std::array<std::size_t, 3> corners_of(std::size_t mode, std::size_t face)
{
    if (mode == kTriangles)
    {
        return {3 * face, 3 * face + 1, 3 * face + 2};
    }
    if (mode == kStrip)
    {
        return {face, face + 1 + face % 2, face + 2 - face % 2};
    }
    return {face + 1, face + 2, 0};
}

/// One mesh, primitive by primitive. Vertices of an accessor that primitives share are shared.
class MeshBuilder
{
public:
    explicit MeshBuilder(GltfFile& file) : file_(file) {}

    /// `charge` is told how much work is ahead, and may throw.
    template <typename Charge>
    void add(const JsonAt& primitive, const Charge& charge)
    {
        refuse_what_moves(file_, primitive);
        const std::size_t mode = mode_of(primitive);
        const std::size_t number = accessor_of(file_, primitive.at("attributes").at("POSITION"));
        const GltfAccessor positions(file_, number);
        positions.require_positions(file_);
        std::optional<GltfAccessor> indices;
        if (const auto given = primitive.find("indices"))
        {
            indices.emplace(file_, accessor_of(file_, *given));
            indices->require_indices();
        }
        const std::size_t corners = indices ? indices->count() : positions.count();
        if (corners < 3 || (mode == kTriangles && corners % 3 != 0))
        {
            primitive.refuse(
                fmt::format("has {} corners; {}", corners,
                            corners < 3 ? "a triangle has 3" : "triangles have a multiple of 3"));
        }
        const auto [known, is_new] = vertices_.try_emplace(number);
        charge(corners + (is_new ? positions.count() / kElementsPerRead : 0));
        const std::size_t faces = faces_of(mode, corners);
        if (faces > kMaxFaces - mesh_.faces.size())
        {
            primitive.refuse(fmt::format("brings its mesh above {} faces (2^29)", kMaxFaces));
        }
        if (is_new)
        {
            known->second.assign(positions.count(), kUnseen);
        }
        for (std::size_t face = 0; face < faces; ++face)
        {
            auto& out = mesh_.faces.emplace_back();
            const std::array<std::size_t, 3> places = corners_of(mode, face);
            for (std::size_t k = 0; k < 3; ++k)
            {
                const std::size_t element = indices ? indices->index(places[k]) : places[k];
                if (element >= positions.count())
                {
                    indices->json().refuse(fmt::format("has element {}: {}; there are {} positions",
                                                       places[k], element, positions.count()));
                }
                out[k] = vertex(known->second[element], positions, element);
            }
        }
    }

    [[nodiscard]] TriangleMesh take() { return std::move(mesh_); }

private:
    std::uint32_t vertex(std::uint32_t& known, const GltfAccessor& positions, std::size_t element)
    {
        if (known == kUnseen)
        {
            known = static_cast<std::uint32_t>(mesh_.positions.size());
            mesh_.positions.push_back(positions.position(element));
        }
        return known;
    }

    GltfFile& file_;
    TriangleMesh mesh_;
    /// By accessor, which vertex each element became.
    std::map<std::size_t, std::vector<std::uint32_t>> vertices_;
};

} // namespace

TriangleMesh GltfMeshes::read(std::size_t index)
{
    try
    {
        const JsonAt primitives = file_.root().at("meshes").at(index).at("primitives");
        const std::size_t count = primitives.size();
        if (count == 0)
        {
            primitives.refuse("are none");
        }
        MeshBuilder builder(file_);
        for (std::size_t i = 0; i < count; ++i)
        {
            const JsonAt primitive = primitives.at(i);
            builder.add(primitive, [&](std::uint64_t reads) { charge(reads, primitive); });
        }
        return builder.take();
    }
    catch (const SceneFault& fault)
    {
        throw SceneFault{file_.described("meshes", index) + ": " + fault.text};
    }
}

void GltfMeshes::charge(std::uint64_t reads, const JsonAt& primitive)
{
    const std::uint64_t most = kFreeReads + kReadsPerByte * file_.buffer_bytes();
    if (reads > most - reads_)
    {
        primitive.refuse(fmt::format("brings what meshes read above {} elements, {} for each byte "
                                     "of the buffers",
                                     most, kReadsPerByte));
    }
    reads_ += reads;
}

} // namespace tactus::detail
