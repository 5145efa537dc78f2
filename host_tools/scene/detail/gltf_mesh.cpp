// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/scene/detail/gltf_accessor.hpp"
#include "host_tools/scene/detail/gltf_nodes.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/number_form.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
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
constexpr std::uint64_t kAnyMode = 0xFFFF'FFFF;

/// Number of elements of a new accessor that count as one read: its map from elements to vertices
/// takes 4 bytes for each.
constexpr std::uint64_t kElementsPerRead = 16;
constexpr std::uint32_t kUnseen = 0xFFFF'FFFF;

std::size_t mode_of(const JsonAt& primitive)
{
    const auto mode = primitive.find("mode");
    return mode ? mode->index_below(kModes.size(), "modes") : kTriangles;
}

/// True for a primitive in a mode that only an extension defines.
bool is_of_an_extension(const JsonAt& primitive)
{
    const auto mode = primitive.find("mode");
    return mode && mode->json().is_number_unsigned() && mode->whole(kAnyMode) >= kModes.size() &&
           primitive.find("extensions");
}

/// Refuses deformable surfaces, which this reader cannot render.
void refuse_what_moves(const JsonAt& primitive)
{
    if (primitive.size_of("targets") > 0)
    {
        primitive.refuse(
            "has morph targets; a model is rigid: apply or remove them in the modeller (in Blender "
            "shape keys), or exclude the node by extras.tactus.touch = false");
    }
}

/// Refuses a compressed primitive if it has no uncompressed form, that is, if the file requires the
/// extension or the accessor has no data.
void refuse_what_is_compressed(const GltfFile& file, const JsonAt& primitive, std::size_t positions)
{
    constexpr const char* kDraco = "KHR_draco_mesh_compression";
    const auto extensions = primitive.find("extensions");
    const JsonAt accessor = file.root().at("accessors").at(positions);
    const bool has_data = accessor.find("bufferView") || accessor.find("sparse");
    if (extensions && extensions->find(kDraco) && (file.requires_extension(kDraco) || !has_data))
    {
        refuse_compressed(primitive, kDraco);
    }
}

std::size_t accessor_of(const GltfFile& file, const JsonAt& json)
{
    return json.index_below(file.root().size_of("accessors"), "accessors");
}

/// True if an accessor has no elements. The standard forbids that, but programs write it.
bool is_empty(const GltfFile& file, std::size_t accessor)
{
    return file.root().at("accessors").at(accessor).at("count").json() == 0;
}

/// Reason why a primitive has no surface; empty if it may have one.
std::string why_no_surface(const GltfFile& file, const JsonAt& primitive)
{
    if (is_of_an_extension(primitive))
    {
        return "in a mode of an extension";
    }
    const std::size_t mode = mode_of(primitive);
    if (mode < kTriangles)
    {
        return fmt::format("of {}", kModes.at(mode));
    }
    const auto positions = primitive.at("attributes").find("POSITION");
    if (!positions)
    {
        return "without positions";
    }
    const auto indices = primitive.find("indices");
    return is_empty(file, accessor_of(file, indices ? *indices : *positions)) ? "of 0 corners" : "";
}

std::size_t faces_of(std::size_t mode, std::size_t corners)
{
    return mode == kTriangles ? corners / 3 : corners - 2;
}

/// Indices of a face's corners within its primitive, in the standard's order, which keeps the
/// winding.
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

/// Builds one mesh, primitive by primitive. Primitives that share an accessor share its vertices.
class MeshBuilder
{
public:
    explicit MeshBuilder(GltfFile& file) : file_(file) {}

    /// Adds a primitive, or returns the reason why it has no surface and is ignored; empty if
    /// added. `charge` is called with the number of reads before the elements are read. If it
    /// throws, the builder must be discarded.
    template <typename Charge>
    [[nodiscard]] std::string add(const JsonAt& primitive, const Charge& charge)
    {
        if (std::string reason = why_no_surface(file_, primitive); !reason.empty())
        {
            return reason;
        }
        refuse_what_moves(primitive);
        const std::size_t mode = mode_of(primitive);
        const std::size_t number = accessor_of(file_, primitive.at("attributes").at("POSITION"));
        refuse_what_is_compressed(file_, primitive, number);
        const GltfAccessor positions(file_, number);
        positions.require_positions(file_);
        std::optional<GltfAccessor> indices;
        if (const auto given = primitive.find("indices"))
        {
            indices.emplace(file_, accessor_of(file_, *given));
            indices->require_indices();
        }
        const std::size_t corners = indices ? indices->count() : positions.count();
        if (corners < 3)
        {
            return "of " + counted(corners, "corner");
        }
        if (mode == kTriangles && corners % 3 != 0)
        {
            primitive.refuse(
                fmt::format("has {} corners; triangles have a multiple of 3", corners));
        }
        const auto [known, is_new] = vertices_.try_emplace(number);
        charge(corners + (is_new ? positions.count() / kElementsPerRead : 0));
        const std::size_t faces = faces_of(mode, corners);
        if (faces > kMaxFaces - mesh_.faces.size())
        {
            primitive.refuse(
                fmt::format("exceeds the limit of {} faces of a mesh (2^29)", kMaxFaces));
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
        return "";
    }

    [[nodiscard]] TriangleMesh take() { return std::move(mesh_); }

private:
    std::uint32_t vertex(std::uint32_t& known, const GltfAccessor& positions, std::size_t element)
    {
        if (known == kUnseen)
        {
            known = static_cast<std::uint32_t>(mesh_.positions.size());
            mesh_.positions.push_back(positions.numbers<3>(element));
        }
        return known;
    }

    GltfFile& file_;
    TriangleMesh mesh_;
    /// Vertex of each element, by accessor; kUnseen for unused elements.
    std::map<std::size_t, std::vector<std::uint32_t>> vertices_;
};

bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& face)
{
    const Vec3 a(mesh.positions[face[0]].data());
    const Vec3 b(mesh.positions[face[1]].data());
    const Vec3 c(mesh.positions[face[2]].data());
    return !(b - a).cross(c - a).isZero(0.0);
}

SceneMesh with_left_out(TriangleMesh mesh, const std::map<std::string, std::size_t>& reasons)
{
    SceneMesh result;
    const auto add = [&result](const std::string& text)
    { result.left_out += (result.left_out.empty() ? "" : ", ") + text; };
    for (const auto& [reason, count] : reasons)
    {
        add(counted(count, "primitive") + " " + reason);
    }
    const bool has_surface =
        std::ranges::any_of(mesh.faces, [&mesh](const auto& face) { return has_area(mesh, face); });
    if (has_surface)
    {
        result.mesh = std::move(mesh);
    }
    else if (!mesh.faces.empty())
    {
        add(counted(mesh.faces.size(), "face") + " without area");
    }
    else if (reasons.empty())
    {
        add("no primitives");
    }
    return result;
}

} // namespace

SceneMesh GltfMeshes::read(std::size_t index)
{
    try
    {
        const JsonAt mesh = file_.root().at("meshes").at(index);
        const std::size_t count = mesh.size_of("primitives");
        MeshBuilder builder(file_);
        std::map<std::string, std::size_t> left_out; // Number of ignored primitives, by reason.
        for (std::size_t i = 0; i < count; ++i)
        {
            const JsonAt primitive = mesh.at("primitives").at(i);
            const std::string reason =
                builder.add(primitive, [&](std::uint64_t reads) { charge(reads, primitive); });
            left_out[reason] += reason.empty() ? 0U : 1U;
        }
        left_out.erase("");
        return with_left_out(builder.take(), left_out);
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
        primitive.refuse(fmt::format("exceeds the limit of {} elements that meshes may read, {} "
                                     "for each byte of the buffers",
                                     most, kReadsPerByte));
    }
    reads_ += reads;
}

} // namespace tactus::detail
