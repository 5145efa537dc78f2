// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_edit/edited_surface.hpp"

#include "host_tools/encode/replay.hpp"
#include "tests/shared/closest_point.hpp"
#include "tests/shared/random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace tactus::test
{
namespace
{

using FloatFace = std::array<Vec3f, 3>;

FloatFace least_first(FloatFace face)
{
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

/// Box mesh from -half to half, with top heights added to z on its upper side.
template <typename Height>
TriangleMesh box_mesh(const std::array<double, 3>& half, std::uint32_t cells, const Height& height)
{
    TriangleMesh mesh;
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> found;
    const auto vertex = [&](const std::array<std::uint32_t, 3>& at)
    {
        const auto [place, is_new] =
            found.try_emplace(at, static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new)
        {
            auto& point = mesh.positions.emplace_back();
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                point[axis] = half[axis] * (2.0 * at[axis] / cells - 1.0);
            }
            if (at[2] == cells)
            {
                point[2] += height(mesh.positions.size());
            }
        }
        return place->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        for (const std::uint32_t side : {0U, cells})
        {
            for (std::uint32_t i = 0; i < cells; ++i)
            {
                for (std::uint32_t k = 0; k < cells; ++k)
                {
                    const auto corner = [&](std::uint32_t u, std::uint32_t v)
                    {
                        std::array<std::uint32_t, 3> at{};
                        at[axis] = side;
                        at[(axis + 1) % 3] = i + u;
                        at[(axis + 2) % 3] = k + v;
                        return vertex(at);
                    };
                    const std::array<std::uint32_t, 4> square{corner(0, 0), corner(1, 0),
                                                              corner(1, 1), corner(0, 1)};
                    const bool is_turned = side == 0;
                    for (const auto& [b, c] : {std::pair{1U, 2U}, std::pair{2U, 3U}})
                    {
                        mesh.faces.push_back(
                            {square[0], square[is_turned ? c : b], square[is_turned ? b : c]});
                    }
                }
            }
        }
    }
    return mesh;
}

} // namespace

Soup soup_of(const TriangleMesh& mesh)
{
    Soup soup;
    for (const auto& face : mesh.faces)
    {
        SoupFace corners;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto& at = mesh.positions[face[i]];
            corners[i] = {at[0], at[1], at[2]};
        }
        soup.push_back(corners);
    }
    return soup;
}

double winding_number(const Soup& soup, const Vec3& point)
{
    double sum = 0.0;
    for (const SoupFace& face : soup)
    {
        const Vec3 a = face[0] - point;
        const Vec3 b = face[1] - point;
        const Vec3 c = face[2] - point;
        const double la = a.norm();
        const double lb = b.norm();
        const double lc = c.norm();
        sum += 2.0 * std::atan2(a.dot(b.cross(c)),
                                la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (4.0 * std::numbers::pi);
}

double distance_to(const Soup& soup, const Vec3& point)
{
    double least = std::numeric_limits<double>::max();
    for (const SoupFace& face : soup)
    {
        // Rejects by the distance from the first corner less the longest edge.
        const double longest = std::max((face[1] - face[0]).norm(), (face[2] - face[0]).norm());
        if ((face[0] - point).norm() - longest < least)
        {
            const auto array_of = [](const Vec3& v) { return Point<double>{v.x(), v.y(), v.z()}; };
            const Point<double> nearest = closest_on_triangle(array_of(point), array_of(face[0]),
                                                              array_of(face[1]), array_of(face[2]));
            least = std::min(least, (Vec3(nearest[0], nearest[1], nearest[2]) - point).norm());
        }
    }
    return least;
}

double volume_of(const Soup& soup)
{
    double sum = 0.0;
    for (const SoupFace& face : soup)
    {
        sum += face[0].dot(face[1].cross(face[2])) / 6.0;
    }
    return sum;
}

std::size_t open_edges(const TriangleMesh& mesh)
{
    std::map<std::pair<std::array<double, 3>, std::array<double, 3>>, int> edges;
    for (const auto& face : mesh.faces)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto& from = mesh.positions[face[i]];
            const auto& to = mesh.positions[face[(i + 1) % 3]];
            from < to ? ++edges[{from, to}] : --edges[{to, from}];
        }
    }
    std::size_t open = 0;
    for (const auto& [edge, count] : edges)
    {
        open += static_cast<std::size_t>(std::abs(count));
    }
    return open;
}

EditedFaces::EditedFaces(const DecodedModel& model, std::uint32_t room)
    : source_ids_(model.header().counts().face_ids())
    , room_(room)
    , extent_(model.header().fields().extent_quanta)
    , quantum_m_(static_cast<double>(model.header().quantum_m()))
{
    Replay replay(model);
    for (const RecordId id : in_dependency_order(model))
    {
        if (replay.split(id))
        {
            return;
        }
    }
    for (std::uint32_t id = 0; id < source_ids_; ++id)
    {
        if (replay.is_active({id}))
        {
            const auto& corners = replay.corners({id});
            faces_[id] = {model.position_m(corners[0]), model.position_m(corners[1]),
                          model.position_m(corners[2])};
        }
    }
}

std::string EditedFaces::apply(const EditContent& edit)
{
    if (edit.revision != ++revision_)
    {
        return fmt::format("revision {} follows {}", edit.revision, revision_ - 1);
    }
    if (edit.removed.size() > 1'024 || edit.added.size() > 1'024)
    {
        return "too large";
    }
    if (edit.removed.empty() && edit.added.empty())
    {
        return "empty";
    }
    Aabb box;
    for (const FaceId id : edit.removed)
    {
        const auto face = faces_.find(id.value);
        if (face == faces_.end())
        {
            return fmt::format("face {} is removed but not there", id.value);
        }
        for (const Vec3f& corner : face->second)
        {
            if (id.value < source_ids_)
            {
                box.add(corner);
            }
        }
        faces_.erase(face);
    }
    if (!(box == edit.removed_m))
    {
        return "box of removed faces differs";
    }
    for (const AddedFace& face : edit.added)
    {
        if (face.slot >= room_ ||
            !faces_.try_emplace(source_ids_ + face.slot, face.corners_m).second)
        {
            return fmt::format("slot {} is used or too large", face.slot);
        }
        for (const Vec3f& corner : face.corners_m)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const double quanta = static_cast<double>(corner[axis]) / quantum_m_;
                if (quanta != std::round(quanta) || quanta < 0.0 || quanta > extent_[axis])
                {
                    return fmt::format("coordinate {} leaves the grid", quanta);
                }
            }
        }
    }
    return {};
}

std::vector<FloatFace> EditedFaces::sorted() const
{
    std::vector<FloatFace> result;
    for (const auto& [id, face] : faces_)
    {
        result.push_back(least_first(face));
    }
    std::sort(result.begin(), result.end());
    return result;
}

std::vector<FloatFace> sorted_faces(const SurfaceEditor& editor, const Vec3& origin_m)
{
    std::vector<FloatFace> result;
    for (const SoupFace& face : soup_of(editor.surface()))
    {
        FloatFace corners;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Vec3 at = face[i] - origin_m;
            corners[i] = {static_cast<float>(at.x()), static_cast<float>(at.y()),
                          static_cast<float>(at.z())};
        }
        result.push_back(least_first(corners));
    }
    std::sort(result.begin(), result.end());
    return result;
}

TriangleMesh make_cube(std::uint32_t cells)
{
    return box_mesh({0.05, 0.05, 0.05}, cells, [](std::size_t) { return 0.0; });
}

TriangleMesh make_noisy_plate(std::uint32_t cells, std::uint64_t seed)
{
    return box_mesh({0.05, 0.05, 0.01}, cells,
                    [&](std::size_t vertex) { return 5e-4 * signed_unit(seed, vertex); });
}

} // namespace tactus::test
