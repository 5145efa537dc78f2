// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/edit/surface_editor.hpp"

#include "host_tools/edit/merge_pieces.hpp"
#include "host_tools/encode/replay.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace tactus
{

namespace
{

/// Number of times that a region is shifted again if an exact decision meets zero.
constexpr std::uint64_t kShifts = 16;
/// Largest number of faces that are compared in the search for a near one.
constexpr std::size_t kBucketSamples = 256;

Triangle to_triangle(const GridTriangle& face)
{
    return {to_vec3(face[0]), to_vec3(face[1]), to_vec3(face[2])};
}

std::int32_t clamped(double value)
{
    return static_cast<std::int32_t>(std::clamp(value, -0x1p30, 0x1p30));
}

GridBox box_round(const Polyhedron& polyhedron)
{
    GridBox box;
    for (const Vec3& vertex : polyhedron.vertices)
    {
        box.add({clamped(std::floor(vertex.x())), clamped(std::floor(vertex.y())),
                 clamped(std::floor(vertex.z()))});
        box.add({clamped(std::ceil(vertex.x())), clamped(std::ceil(vertex.y())),
                 clamped(std::ceil(vertex.z()))});
    }
    return box;
}

double diagonal_of(const GridBox& box)
{
    return (to_vec3(box.high) - to_vec3(box.low)).norm();
}

GridBox inflated(const GridBox& box, double margin)
{
    GridBox result = box;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        result.low[axis] = clamped(static_cast<double>(box.low[axis]) - margin);
        result.high[axis] = clamped(static_cast<double>(box.high[axis]) + margin);
    }
    return result;
}

/// The face with its least corner first.
GridTriangle normal_form(const GridTriangle& face)
{
    const auto least = std::min_element(face.begin(), face.end()) - face.begin();
    GridTriangle result = face;
    std::rotate(result.begin(), result.begin() + least, result.end());
    return result;
}

GridTriangle turned_over(const GridTriangle& face)
{
    return {face[0], face[2], face[1]};
}

/// Drops added faces without three corners, pairs of opposite added faces, and faces that are
/// removed and added again.
template <typename Faces>
void drop_idle(std::vector<std::uint32_t>& removed, std::vector<SurfaceFace>& added,
               const Faces& faces)
{
    std::map<GridTriangle, std::vector<std::size_t>> kept;
    std::vector<bool> is_dropped(added.size());
    for (std::size_t i = 0; i < added.size(); ++i)
    {
        const GridTriangle& corners = added[i].corners;
        is_dropped[i] =
            corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
        if (is_dropped[i])
        {
            continue;
        }
        const auto opposite = kept.find(normal_form(turned_over(corners)));
        if (opposite != kept.end() && !opposite->second.empty())
        {
            is_dropped[i] = true;
            is_dropped[opposite->second.back()] = true;
            opposite->second.pop_back();
            continue;
        }
        kept[normal_form(corners)].push_back(i);
    }
    std::erase_if(removed,
                  [&](std::uint32_t id)
                  {
                      const auto same = kept.find(normal_form(faces[id].corners));
                      if (same == kept.end() || same->second.empty())
                      {
                          return false;
                      }
                      is_dropped[same->second.back()] = true;
                      same->second.pop_back();
                      return true;
                  });
    std::size_t i = 0;
    std::erase_if(added, [&](const SurfaceFace&) { return is_dropped[i++]; });
}

} // namespace

Result<SurfaceEditor, Refusal> SurfaceEditor::create(const DecodedModel& model, std::uint32_t room)
{
    if (room > kMaxAddedFaces)
    {
        return Refusal{
            fmt::format("room for {} added faces: at most {} are allowed", room, kMaxAddedFaces)};
    }
    const ModelCounts counts = model.header().counts();
    Replay replay(model);
    for (const RecordId id : in_dependency_order(model))
    {
        if (auto fault = replay.split(id))
        {
            return Refusal{*std::move(fault)};
        }
    }
    const auto quantum = static_cast<double>(model.header().quantum_m());
    const auto grid_point = [&](VertexId vertex)
    {
        const Vec3f& at_m = model.position_m(vertex);
        GridPoint point{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            point[axis] =
                static_cast<std::int32_t>(std::lround(static_cast<double>(at_m[axis]) / quantum));
        }
        return point;
    };
    const auto face_of = [&](std::uint32_t id)
    {
        const auto& corners = replay.corners({id});
        SurfaceFace face;
        face.corners = {grid_point(corners[0]), grid_point(corners[1]), grid_point(corners[2])};
        const std::uint32_t added = id - std::min(id, counts.base_faces);
        face.bucket = counts.is_base(FaceId{id}) ? model.base_faces()[id].bucket
                                                 : model.record({added / 2}).bucket[added % 2];
        return face;
    };
    double sizes = 0.0;
    for (std::uint32_t id = 0; id < counts.face_ids(); ++id)
    {
        if (replay.is_active({id}))
        {
            sizes += diagonal_of(box_of(face_of(id).corners));
        }
    }
    SurfaceEditor editor(model, room,
                         static_cast<std::uint32_t>(sizes / std::max(1U, replay.face_count())));
    for (std::uint32_t id = 0; id < counts.face_ids(); ++id)
    {
        if (replay.is_active({id}))
        {
            editor.faces_.add(id, face_of(id));
        }
    }
    return editor;
}

SurfaceEditor::SurfaceEditor(const DecodedModel& model, std::uint32_t room,
                             std::uint32_t typical_size)
    : grid_{model.header().origin_m(), static_cast<double>(model.header().quantum_m())}
    , is_closed_(model.header().is_closed())
    , source_ids_(model.header().counts().face_ids())
    , room_(room)
    , faces_(source_ids_ + room, typical_size, model.header().fields().source_faces)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        extent_[axis] = static_cast<std::int32_t>(model.header().fields().extent_quanta[axis]);
    }
    for (std::uint32_t slot = 0; slot < room; ++slot)
    {
        free_slots_.push_back(slot); // Ascending numbers are a heap.
    }
}

Result<SurfaceChange, Refusal> SurfaceEditor::carve(const Sweep& sweep)
{
    return cut(sweep, CutSense::carve);
}

Result<SurfaceChange, Refusal> SurfaceEditor::fill(const Sweep& sweep)
{
    return cut(sweep, CutSense::fill);
}

Result<SurfaceChange, Refusal> SurfaceEditor::cut(const Sweep& sweep, CutSense sense)
{
    for (std::uint64_t shift = 0; shift < kShifts; ++shift)
    {
        auto region = swept_region(sweep, grid_, kShifts * revision_ + shift);
        if (!region)
        {
            return region.error();
        }
        std::vector<Triangle> touched;
        for (const std::uint32_t id :
             faces_.in_box(inflated(box_round(region.value().polyhedron),
                                    region.value().slack_quanta + kSweptTouch_quanta)))
        {
            touched.push_back(to_triangle(faces_[id].corners));
        }
        std::unordered_map<const void*, bool> known;
        const auto is_solid = [&](const Vec3& point)
        {
            const auto [at, is_new] = known.try_emplace(&point);
            if (is_new)
            {
                at->second = is_closed_ && winding_of(point).value_or(0) > 0;
            }
            return at->second;
        };
        withdraw_from(touched, sense, is_solid, region.value());
        if (region.value().polyhedron.facets.empty())
        {
            return SurfaceChange{};
        }
        if (auto plan = plan_cut(region.value(), sense))
        {
            auto change = apply(*std::move(plan));
            if (change && sense == CutSense::fill)
            {
                change.value().volume_m3 = -change.value().volume_m3;
            }
            return change;
        }
    }
    return Refusal{"sweep: its surface can't be told from that of the model"};
}

std::optional<SurfaceEditor::Plan> SurfaceEditor::plan_cut(const SweptRegion& region,
                                                           CutSense sense) const
{
    const GridBox box = box_round(region.polyhedron);
    const std::vector<std::uint32_t> near = faces_.in_box(box);
    std::vector<CutFace> faces;
    faces.reserve(near.size());
    for (const std::uint32_t id : near)
    {
        faces.push_back({to_triangle(faces_[id].corners), false});
    }
    std::optional<int> winding;
    if (is_closed_)
    {
        winding = winding_of(region.polyhedron.vertices[0]);
        if (!winding)
        {
            return std::nullopt;
        }
    }
    else if (!near.empty())
    {
        add_walls(box, faces);
    }
    auto cut = cut_surface(faces, region.polyhedron, sense, winding);
    if (!cut)
    {
        return std::nullopt;
    }
    Plan plan;
    for (const std::uint32_t face : cut->removed)
    {
        plan.removed.push_back(near[face]);
    }
    const std::vector<std::uint32_t>& nearby = plan.removed.empty() ? near : plan.removed;
    for (const CutPiece& piece : cut->pieces)
    {
        const bool is_facet = piece.parent == CutPiece::kFacet;
        plan.added.push_back(
            {piece.corners,
             is_facet ? bucket_near(piece.corners, nearby) : faces_[near[piece.parent]].bucket,
             {}});
    }
    hand_down_marks(*cut, near, region.slack_quanta, plan.added);
    drop_idle(plan.removed, plan.added, faces_);
    merge(plan, region.slack_quanta);
    return plan;
}

void SurfaceEditor::hand_down_marks(const SurfaceCut& cut, const std::vector<std::uint32_t>& near,
                                    double slack_quanta, std::vector<SurfaceFace>& added) const
{
    std::vector<Triangle> pieces;
    for (std::size_t first = 0; first < cut.pieces.size(); first += pieces.size())
    {
        const std::uint32_t parent = cut.pieces[first].parent;
        pieces.clear();
        for (std::size_t i = first; i < cut.pieces.size() && cut.pieces[i].parent == parent; ++i)
        {
            pieces.push_back(to_triangle(added[i].corners));
        }
        if (parent == CutPiece::kFacet)
        {
            continue;
        }
        for (const Vec3& mark : faces_[near[parent]].marks)
        {
            const auto [nearest, distance_sq] = nearest_of(pieces, mark);
            if (distance_sq <= slack_quanta * slack_quanta)
            {
                added[first + nearest].marks.push_back(mark);
            }
        }
    }
}

void SurfaceEditor::merge(Plan& plan, double slack_quanta) const
{
    std::unordered_set<GridPoint, GridPointHash> points;
    GridBox box;
    for (const SurfaceFace& face : plan.added)
    {
        for (const GridPoint& corner : face.corners)
        {
            points.insert(corner);
            box.add(corner);
        }
    }
    if (points.empty())
    {
        return;
    }
    // Faces around: added ones are merged, too; those of the source stay.
    const std::unordered_set<std::uint32_t> gone(plan.removed.begin(), plan.removed.end());
    std::vector<GridPoint> fixed;
    for (const std::uint32_t id : faces_.in_box(box))
    {
        const GridTriangle& corners = faces_[id].corners;
        if (gone.contains(id) ||
            std::none_of(corners.begin(), corners.end(),
                         [&](const GridPoint& corner) { return points.contains(corner); }))
        {
            continue;
        }
        for (const GridPoint& corner : corners)
        {
            if (id < source_ids_ || !points.contains(corner))
            {
                fixed.push_back(corner);
            }
        }
        if (id >= source_ids_)
        {
            plan.removed.push_back(id);
            plan.added.push_back(faces_[id]);
        }
    }
    merge_pieces(plan.added, fixed, slack_quanta);
}

std::optional<int> SurfaceEditor::winding_of(const Vec3& point) const
{
    const bool is_high = 2.0 * point.x() > static_cast<double>(extent_[0]);
    Vec3 far = point;
    far.x() = is_high ? std::max(point.x(), static_cast<double>(extent_[0])) + 1.0
                      : std::min(point.x(), 0.0) - 1.0;
    GridBox line;
    for (const Vec3& end : {point, far})
    {
        line.add({clamped(std::floor(end.x())), clamped(std::floor(end.y())),
                  clamped(std::floor(end.z()))});
        line.add({clamped(std::ceil(end.x())), clamped(std::ceil(end.y())),
                  clamped(std::ceil(end.z()))});
    }
    std::vector<CutFace> faces;
    for (const std::uint32_t id : faces_.in_box(line))
    {
        faces.push_back({to_triangle(faces_[id].corners), false});
    }
    const auto sum = crossings(point, far, faces);
    return sum ? std::optional(-*sum) : std::nullopt;
}

void SurfaceEditor::add_walls(const GridBox& region, std::vector<CutFace>& faces) const
{
    const GridBox box = inflated(region, diagonal_of(region));
    std::map<std::pair<GridPoint, GridPoint>, int> edges;
    for (const std::uint32_t id : faces_.in_box(box))
    {
        const GridTriangle& corners = faces_[id].corners;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const GridPoint& from = corners[i];
            const GridPoint& to = corners[(i + 1) % 3];
            GridBox edge;
            edge.add(from);
            edge.add(to);
            if (edge.meets(box))
            {
                from < to ? ++edges[{from, to}] : --edges[{to, from}];
            }
        }
    }
    const double depth = 4.0 * diagonal_of(box);
    for (const auto& [edge, count] : edges)
    {
        if (count == 0)
        {
            continue;
        }
        const auto& [from, to] = count > 0 ? edge : std::pair(edge.second, edge.first);
        const Vec3 a = to_vec3(from);
        const Vec3 b = to_vec3(to);
        const Vec3 below_a = a - depth * normal_at(from);
        const Vec3 below_b = b - depth * normal_at(to);
        faces.push_back({{b, a, below_a}, true});
        faces.push_back({{b, below_a, below_b}, true});
    }
}

Vec3 SurfaceEditor::normal_at(const GridPoint& point) const
{
    GridBox box;
    box.add(point);
    Vec3 sum(0.0, 0.0, 0.0);
    for (const std::uint32_t id : faces_.in_box(box))
    {
        const GridTriangle& corners = faces_[id].corners;
        if (std::find(corners.begin(), corners.end(), point) != corners.end())
        {
            const Triangle at = to_triangle(corners);
            sum += (at[1] - at[0]).cross(at[2] - at[0]);
        }
    }
    return sum.normalized();
}

std::uint32_t SurfaceEditor::bucket_near(const GridTriangle& face,
                                         const std::vector<std::uint32_t>& nearby) const
{
    std::uint32_t bucket = 0;
    double least = std::numeric_limits<double>::max();
    const std::size_t stride = std::max<std::size_t>(1, nearby.size() / kBucketSamples);
    for (std::size_t i = 0; i < nearby.size(); i += stride)
    {
        const double distance =
            (to_vec3(faces_[nearby[i]].corners[0]) - to_vec3(face[0])).squaredNorm();
        if (distance < least)
        {
            least = distance;
            bucket = faces_[nearby[i]].bucket;
        }
    }
    return bucket;
}

Result<SurfaceChange, Refusal> SurfaceEditor::displace(const Vec3& center_m, double radius_m,
                                                       const Vec3& vector_m)
{
    const Vec3 center = grid_.to_quanta(center_m);
    const double radius = radius_m / grid_.quantum_m;
    const Vec3 vector = vector_m / grid_.quantum_m;
    constexpr double kFarthest = 0x1p29;
    if (!(radius > 0.0 && radius <= kFarthest && center.cwiseAbs().maxCoeff() <= kFarthest &&
          vector.cwiseAbs().maxCoeff() <= kFarthest))
    {
        return Refusal{fmt::format("displacement: center, radius and vector must be finite and "
                                   "within {:.3g} m of the model",
                                   kFarthest * grid_.quantum_m)};
    }
    GridBox box;
    for (const double side : {-radius, radius})
    {
        const Vec3 corner = center + Vec3::Constant(side);
        box.add({clamped(std::floor(corner.x())), clamped(std::floor(corner.y())),
                 clamped(std::floor(corner.z()))});
        box.add({clamped(std::ceil(corner.x())), clamped(std::ceil(corner.y())),
                 clamped(std::ceil(corner.z()))});
    }
    const auto moved = [&](const Vec3& point)
    {
        const double share = (point - center).squaredNorm() / (radius * radius);
        const double part = share < 1.0 ? (1.0 - share) * (1.0 - share) : 0.0;
        return Vec3(point + part * vector);
    };
    Plan plan;
    for (const std::uint32_t id : faces_.in_box(box))
    {
        SurfaceFace face = faces_[id];
        for (GridPoint& corner : face.corners)
        {
            const Vec3 at = moved(to_vec3(corner));
            corner = {clamped(std::round(at.x())), clamped(std::round(at.y())),
                      clamped(std::round(at.z()))};
        }
        std::transform(face.marks.begin(), face.marks.end(), face.marks.begin(), moved);
        if (face.corners != faces_[id].corners)
        {
            plan.removed.push_back(id);
            plan.added.push_back(face);
        }
    }
    auto change = apply(std::move(plan));
    if (change)
    {
        change.value().volume_m3 = -change.value().volume_m3;
    }
    return change;
}

std::optional<Refusal> SurfaceEditor::fault_of(const Plan& plan) const
{
    if (plan.removed.size() + plan.added.size() > kMaxChangedFaces)
    {
        return Refusal{fmt::format("edit: changes {} faces; at most {} are allowed",
                                   plan.removed.size() + plan.added.size(), kMaxChangedFaces)};
    }
    if (plan.removed.size() == faces_.count() && plan.added.empty())
    {
        return Refusal{"edit: would remove the whole surface"};
    }
    for (const SurfaceFace& face : plan.added)
    {
        for (const GridPoint& corner : face.corners)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                if (corner[axis] < 0 || corner[axis] > extent_[axis])
                {
                    return Refusal{fmt::format(
                        "edit: a new face would leave the model's box along {}: {:.6g} m, "
                        "allowed {:.6g} to {:.6g} m",
                        "xyz"[axis],
                        grid_.origin_m[static_cast<Eigen::Index>(axis)] +
                            corner[axis] * grid_.quantum_m,
                        grid_.origin_m[static_cast<Eigen::Index>(axis)],
                        grid_.origin_m[static_cast<Eigen::Index>(axis)] +
                            extent_[axis] * grid_.quantum_m)};
                }
            }
        }
    }
    return std::nullopt;
}

double SurfaceEditor::volume_quanta(const Plan& plan) const
{
    std::optional<Vec3> origin;
    double sum = 0.0;
    const auto add = [&](const GridTriangle& face, double sign)
    {
        origin = origin ? origin : to_vec3(face[0]);
        sum += sign *
               (to_vec3(face[0]) - *origin)
                   .dot((to_vec3(face[1]) - *origin).cross(to_vec3(face[2]) - *origin)) /
               6.0;
    };
    for (const std::uint32_t id : plan.removed)
    {
        add(faces_[id].corners, 1.0);
    }
    for (const SurfaceFace& face : plan.added)
    {
        add(face.corners, -1.0);
    }
    return sum;
}

AddedFace SurfaceEditor::added_face(std::uint32_t slot, const SurfaceFace& face) const
{
    AddedFace added{slot, face.bucket, {}};
    for (std::size_t i = 0; i < 3; ++i)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            added.corners_m[i][axis] = static_cast<float>(face.corners[i][axis] * grid_.quantum_m);
        }
    }
    return added;
}

Result<SurfaceChange, Refusal> SurfaceEditor::apply(Plan plan)
{
    drop_idle(plan.removed, plan.added, faces_);
    if (auto fault = fault_of(plan))
    {
        return *std::move(fault);
    }
    const bool is_single =
        plan.removed.size() <= kMaxEditFaces && plan.added.size() <= kMaxEditFaces;
    // Slots that a single edit frees are free for its own faces.
    std::vector<std::uint32_t> freed;
    for (const std::uint32_t id : plan.removed)
    {
        if (id >= source_ids_)
        {
            freed.push_back(id - source_ids_);
        }
    }
    const std::size_t free = free_slots_.size() + (is_single ? freed.size() : 0);
    if (plan.added.size() > free)
    {
        return Refusal{fmt::format("edit: adds {} faces, but only {} of the room for {} are free",
                                   plan.added.size(), free, room_)};
    }
    const auto give_back = [&]
    {
        for (const std::uint32_t slot : freed)
        {
            free_slots_.push_back(slot);
            std::push_heap(free_slots_.begin(), free_slots_.end(), std::greater<>());
        }
    };
    if (is_single)
    {
        give_back();
    }
    SurfaceChange change;
    change.volume_m3 = volume_quanta(plan) * grid_.quantum_m * grid_.quantum_m * grid_.quantum_m;
    const auto next_edit = [&](bool starts_new) -> EditContent&
    {
        if (starts_new)
        {
            change.edits.emplace_back().revision = ++revision_;
        }
        return change.edits.back();
    };
    std::vector<std::uint32_t> slots;
    for (std::size_t i = 0; i < plan.added.size(); ++i)
    {
        std::pop_heap(free_slots_.begin(), free_slots_.end(), std::greater<>());
        slots.push_back(free_slots_.back());
        free_slots_.pop_back();
        next_edit(i % kMaxEditFaces == 0).added.push_back(added_face(slots.back(), plan.added[i]));
    }
    for (std::size_t i = 0; i < plan.removed.size(); ++i)
    {
        const bool starts_new = i % kMaxEditFaces == 0 && (!is_single || change.edits.empty());
        EditContent& edit = next_edit(starts_new);
        const std::uint32_t id = plan.removed[i];
        edit.removed.push_back({id});
        if (id < source_ids_)
        {
            for (const Vec3f& corner : added_face(0, faces_[id]).corners_m)
            {
                edit.removed_m.add(corner);
            }
        }
    }
    for (const std::uint32_t id : plan.removed)
    {
        faces_.remove(id);
    }
    for (std::size_t i = 0; i < plan.added.size(); ++i)
    {
        faces_.add(source_ids_ + slots[i], plan.added[i]);
    }
    if (!is_single)
    {
        give_back();
    }
    return change;
}

TriangleMesh SurfaceEditor::surface() const
{
    TriangleMesh mesh;
    std::unordered_map<GridPoint, std::uint32_t, GridPointHash> places;
    for (std::uint32_t id = 0; id < faces_.ids(); ++id)
    {
        if (!faces_.has(id))
        {
            continue;
        }
        std::array<std::uint32_t, 3> face{};
        for (std::size_t i = 0; i < 3; ++i)
        {
            const GridPoint& corner = faces_[id].corners[i];
            const auto [place, is_new] =
                places.try_emplace(corner, static_cast<std::uint32_t>(mesh.positions.size()));
            if (is_new)
            {
                const Vec3 at_m = grid_.origin_m + grid_.quantum_m * to_vec3(corner);
                mesh.positions.push_back({at_m.x(), at_m.y(), at_m.z()});
            }
            face[i] = place->second;
        }
        mesh.faces.push_back(face);
    }
    return mesh;
}

} // namespace tactus
