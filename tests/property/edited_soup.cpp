// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/property/edited_soup.hpp"

#include "tests/shared/frame_rig.hpp"
#include "tests/stability/whole_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>

namespace tactus::test
{

namespace
{

/// Part of the source that random edits leave.
constexpr double kLeastLeft = 0.5;

[[noreturn]] void end_for(const std::string& model, const std::string& reason)
{
    std::fprintf(stderr, "edited soup of %s: %s\n", model.c_str(), reason.c_str());
    std::exit(2);
}

std::vector<Face> sorted_faces(std::vector<Face> faces)
{
    for (Face& face : faces)
    {
        std::sort(face.begin(), face.end());
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

std::vector<Face> corners_of(const FinestMesh& mesh)
{
    std::vector<Face> corners;
    for (const SourceFace& face : mesh.faces)
    {
        corners.push_back(face.corners);
    }
    return corners;
}

std::vector<std::vector<std::uint32_t>> neighbours_of(const std::vector<SourceFace>& faces)
{
    std::map<Vec3f, std::vector<std::uint32_t>> by_corner;
    for (std::uint32_t i = 0; i < faces.size(); ++i)
    {
        for (const Vec3f& corner : faces[i].corners)
        {
            by_corner[corner].push_back(i);
        }
    }
    std::vector<std::vector<std::uint32_t>> neighbours(faces.size());
    for (std::uint32_t i = 0; i < faces.size(); ++i)
    {
        for (const Vec3f& corner : faces[i].corners)
        {
            const auto& round = by_corner[corner];
            neighbours[i].insert(neighbours[i].end(), round.begin(), round.end());
        }
    }
    return neighbours;
}

std::unique_ptr<FinestMesh> find_finest(const TestModel& model)
{
    FrameRig rig(model, whole_options(model.faces.size()));
    refine_fully(model.name, [&](const Budgets& budgets)
                 { return rig.step(to_vec3(model.faces[0][0]), budgets); });
    const Model& whole = rig.model();
    auto mesh = std::make_unique<FinestMesh>();
    mesh->counts = whole.header.counts();
    mesh->quantum_m = whole.header.quantum_m();
    mesh->extent_quanta = whole.header.fields().extent_quanta;
    for (std::uint32_t i = 0; i < mesh->counts.face_ids(); ++i)
    {
        const PrimId prim = whole.forest.find(FaceId{i});
        if (prim.is_none())
        {
            continue; // A record on a border leaves an id unused.
        }
        const std::uint32_t above = i - std::min(i, mesh->counts.base_faces);
        const std::uint32_t bucket =
            mesh->counts.is_base(FaceId{i})
                ? whole.slots.base.faces[i].bucket
                : whole.pages.resident(RecordId{above / 2}).bucket[above % 2];
        mesh->faces.push_back({FaceId{i}, bucket, whole.forest.corners_of(prim)});
    }
    if (sorted_faces(corners_of(*mesh)) != sorted_faces(model.faces))
    {
        end_for(model.name, "the finest mesh is not the source");
    }
    mesh->neighbours = neighbours_of(mesh->faces);
    return mesh;
}

Vec3 middle_of(const Face& face)
{
    return (to_vec3(face[0]) + to_vec3(face[1]) + to_vec3(face[2])) / 3.0;
}

bool has_equal_corners(const Face& face)
{
    return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

/// Place on the line through a face's first corners, as far from the second as that is from the
/// first; the third corner if that place is outside the model's box.
Vec3f on_line(const FinestMesh& mesh, const Face& face)
{
    Vec3f place{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        place[axis] = 2.0F * face[1][axis] - face[0][axis];
        const float most = static_cast<float>(mesh.extent_quanta[axis]) * mesh.quantum_m;
        if (place[axis] < 0.0F || place[axis] > most)
        {
            return face[2];
        }
    }
    return place;
}

/// Normal as long as twice the area.
Vec3 normal_of(const Face& face)
{
    const Vec3 a = to_vec3(face[0]);
    return (to_vec3(face[1]) - a).cross(to_vec3(face[2]) - a);
}

} // namespace

Vec3f FinestMesh::corner_at(const std::array<std::int64_t, 3>& quanta) const
{
    Vec3f corner{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::int64_t inside =
            std::clamp<std::int64_t>(quanta[axis], 0, std::int64_t{extent_quanta[axis]});
        corner[axis] = static_cast<float>(inside) * quantum_m;
    }
    return corner;
}

const FinestMesh& finest_mesh(const TestModel& model)
{
    static std::map<std::string, std::unique_ptr<FinestMesh>> meshes;
    std::unique_ptr<FinestMesh>& mesh = meshes[model.name];
    if (!mesh)
    {
        mesh = find_finest(model);
    }
    return *mesh;
}

// --- The soup ------------------------------------------------------------------------------------

EditedSoup::EditedSoup(const TestModel& model, std::uint32_t room)
    : source_(finest_mesh(model))
    , room_(room)
    , is_here_(source_.faces.size(), true)
    , sources_here_(static_cast<std::uint32_t>(source_.faces.size()))
    , soup_(model)
{
    for (std::uint32_t i = 0; i < source_.faces.size(); ++i)
    {
        place_of_source_[source_.faces[i].id.value] = i;
    }
    list_faces();
}

void EditedSoup::apply(const OwnedEdit& edit)
{
    if (edit.revision != ++revision_)
    {
        end_for(soup_.name, "a revision out of order");
    }
    for (const FaceId face : edit.removed)
    {
        const auto at = place_of_source_.find(face.value);
        if (at != place_of_source_.end() && is_here_[at->second])
        {
            is_here_[at->second] = false;
            --sources_here_;
        }
        else if (added_.erase(face.value - source_.counts.face_ids()) == 0)
        {
            end_for(soup_.name, "a removed face that is not there");
        }
    }
    for (const AddedFace& face : edit.added)
    {
        if (face.slot >= room_ || !added_.emplace(face.slot, face).second)
        {
            end_for(soup_.name, "an added face in a bad slot");
        }
    }
    added_max_ = std::max(added_max_, static_cast<std::uint32_t>(added_.size()));
    list_faces();
}

std::optional<std::uint32_t> EditedSoup::place_of(FaceId face) const
{
    const auto at = face.is_none() ? places_.end() : places_.find(face.value);
    return at == places_.end() ? std::nullopt : std::optional(at->second);
}

void EditedSoup::list_faces()
{
    oracle_.reset();
    soup_.faces.clear();
    places_.clear();
    const auto list = [this](FaceId id, const Face& corners)
    {
        places_.emplace_hint(places_.end(), id.value,
                             static_cast<std::uint32_t>(soup_.faces.size()));
        soup_.faces.push_back(corners);
    };
    for (std::uint32_t i = 0; i < source_.faces.size(); ++i)
    {
        if (is_here_[i])
        {
            list(source_.faces[i].id, source_.faces[i].corners);
        }
    }
    for (const auto& [slot, face] : added_)
    {
        list(id_of_slot(slot), face.corners_m);
    }
    if (!soup_.faces.empty())
    {
        oracle_.emplace(soup_);
    }
}

// --- Edits ---------------------------------------------------------------------------------------

EditAuthor::EditAuthor(const EditedSoup& soup, Random& random)
    : soup_(soup), random_(random), corners_(corners_of(soup.source())), tree_(corners_)
{
}

OwnedEdit EditAuthor::next(const Vec3& near_m)
{
    const Vec3 place_m = place_for_edit(near_m);
    std::vector<std::uint32_t> sources;
    const std::uint32_t all = static_cast<std::uint32_t>(soup_.source().faces.size());
    if (soup_.sources_here() > kLeastLeft * all)
    {
        switch (random_.below(6U))
        {
        case 0:
            sources = patch(place_m, 1);
            break;
        case 1:
            sources = patch(place_m, 2 + random_.below(std::min(all / 20, kMaxEditFaces - 2)));
            break;
        case 2:
            sources = scatter(1 + random_.below(40U));
            break;
        case 3:
            sources = region(place_m);
            break;
        case 4:
            sources = patch(place_m, 10);
            break;
        default:
            break;
        }
    }
    OwnedEdit edit = removal_of(sources);
    if (random_.one_in(3))
    {
        remove_added(edit);
    }
    if (random_.one_in(2))
    {
        add_lowered(edit, sources);
    }
    if (random_.one_in(4))
    {
        add_triangles(edit, place_m);
    }
    return edit;
}

std::optional<OwnedEdit> EditAuthor::bad(EditRefusal reason, const Vec3& near_m)
{
    OwnedEdit edit = next(near_m);
    const std::uint32_t used = static_cast<std::uint32_t>(soup_.added().size());
    switch (reason)
    {
    case EditRefusal::too_many:
    case EditRefusal::unknown_model:
        return edit;
    case EditRefusal::wrong_revision:
        edit.revision += random_.one_in(2) ? 1U + random_.below(3U) : 0U - 1U;
        return edit;
    case EditRefusal::too_large:
        if (soup_.sources_here() <= kMaxEditFaces)
        {
            return std::nullopt;
        }
        edit = removal_of(patch(near_m, kMaxEditFaces + 1));
        return edit;
    case EditRefusal::unknown_face:
        if (edit.removed.size() == kMaxEditFaces)
        {
            edit.removed.pop_back();
        }
        edit.removed.push_back(soup_.id_of_slot(soup_.room()));
        if (const std::uint32_t gone = random_.below(static_cast<std::uint32_t>(corners_.size()));
            !soup_.is_here(gone))
        {
            edit.removed.back() = soup_.source().faces[gone].id;
        }
        else if (const std::uint32_t slot = random_.below(soup_.room());
                 !soup_.added().contains(slot))
        {
            edit.removed.back() = soup_.id_of_slot(slot);
        }
        return edit;
    case EditRefusal::bad_face:
        break;
    }
    if (used_slots_after(edit) == soup_.room() || edit.added.size() == kMaxEditFaces)
    {
        edit = removal_of({});
    }
    if (used == soup_.room() ||
        !add(edit, any_triangle(near_m, 0.01 * soup_.model().diagonal_m), bucket_near(near_m)))
    {
        return std::nullopt;
    }
    AddedFace& face = edit.added.back();
    float& coordinate = face.corners_m[random_.below(3U)][random_.below(3U)];
    switch (random_.below(5U))
    {
    case 0:
        face.slot = soup_.room() + random_.below(3U);
        break;
    case 1:
        coordinate = -soup_.source().quantum_m;
        break;
    case 2:
        face.corners_m[1][2] =
            static_cast<float>(soup_.source().extent_quanta[2] + 1) * soup_.source().quantum_m;
        break;
    case 3:
        coordinate = std::numeric_limits<float>::quiet_NaN();
        break;
    default: // A slot that the same edit fills.
        edit.added.size() > 1 ? face.slot = edit.added.front().slot
                              : face.slot = std::numeric_limits<std::uint32_t>::max();
        break;
    }
    return edit;
}

Face EditAuthor::any_triangle(const Vec3& near_m, double half_m)
{
    const FinestMesh& mesh = soup_.source();
    Face face{};
    for (Vec3f& corner : face)
    {
        const Vec3 place_m = near_m + random_.in_cube(half_m);
        std::array<std::int64_t, 3> quanta{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            quanta[axis] = std::llround(place_m[static_cast<Eigen::Index>(axis)] /
                                        static_cast<double>(mesh.quantum_m));
        }
        corner = mesh.corner_at(quanta);
    }
    return face;
}

OwnedEdit EditAuthor::removal_of(const std::vector<std::uint32_t>& sources) const
{
    OwnedEdit edit;
    edit.revision = soup_.revision() + 1;
    for (const std::uint32_t source : sources)
    {
        const SourceFace& face = soup_.source().faces[source];
        edit.removed.push_back(face.id);
        for (const Vec3f& corner : face.corners)
        {
            edit.removed_m.add(corner);
        }
    }
    return edit;
}

bool EditAuthor::add(OwnedEdit& edit, const Face& corners, std::uint32_t bucket) const
{
    std::set<std::uint32_t> used;
    for (const auto& entry : soup_.added())
    {
        used.insert(entry.first);
    }
    for (const FaceId face : edit.removed)
    {
        if (face.value >= soup_.source().counts.face_ids())
        {
            used.erase(face.value - soup_.source().counts.face_ids());
        }
    }
    for (const AddedFace& face : edit.added)
    {
        used.insert(face.slot);
    }
    if (edit.added.size() >= kMaxEditFaces || used.size() >= soup_.room())
    {
        return false;
    }
    std::uint32_t slot = static_cast<std::uint32_t>(mixed(edit.revision, edit.added.size()) %
                                                    std::uint64_t{soup_.room()});
    while (used.contains(slot))
    {
        slot = (slot + 1) % soup_.room();
    }
    edit.added.push_back({slot, bucket, corners});
    return true;
}

std::vector<std::uint32_t> EditAuthor::patch(const Vec3& near_m, std::size_t count) const
{
    std::vector<std::uint32_t> order{tree_.nearest(near_m).face};
    std::vector<bool> is_listed(corners_.size(), false);
    is_listed[order[0]] = true;
    std::vector<std::uint32_t> present;
    for (std::size_t i = 0; i < order.size() && present.size() < count; ++i)
    {
        if (soup_.is_here(order[i]))
        {
            present.push_back(order[i]);
        }
        for (const std::uint32_t neighbour : soup_.source().neighbours[order[i]])
        {
            if (!is_listed[neighbour])
            {
                is_listed[neighbour] = true;
                order.push_back(neighbour);
            }
        }
    }
    // Other components, in the order of their ids.
    for (std::uint32_t i = 0; i < corners_.size() && present.size() < count; ++i)
    {
        if (!is_listed[i] && soup_.is_here(i))
        {
            present.push_back(i);
        }
    }
    return present;
}

std::vector<std::uint32_t> EditAuthor::scatter(std::size_t count)
{
    std::set<std::uint32_t> chosen;
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::uint32_t face = random_.below(static_cast<std::uint32_t>(corners_.size()));
        if (soup_.is_here(face))
        {
            chosen.insert(face);
        }
    }
    return {chosen.begin(), chosen.end()};
}

/// All present faces with their middle in a ball.
std::vector<std::uint32_t> EditAuthor::region(const Vec3& near_m)
{
    const double radius_m = random_.between(0.01, 0.08) * soup_.model().diagonal_m;
    std::vector<std::uint32_t> faces;
    for (std::uint32_t i = 0; i < corners_.size() && faces.size() < kMaxEditFaces; ++i)
    {
        if (soup_.is_here(i) && (middle_of(corners_[i]) - near_m).norm() < radius_m)
        {
            faces.push_back(i);
        }
    }
    return faces;
}

/// Removes up to all added faces.
void EditAuthor::remove_added(OwnedEdit& edit)
{
    const std::uint32_t share = 1 + random_.below(4U);
    for (const auto& entry : soup_.added())
    {
        if (edit.removed.size() < kMaxEditFaces && random_.one_in(share))
        {
            edit.removed.push_back(soup_.id_of_slot(entry.first));
        }
    }
}

/// Copies of faces, moved together against the mean of their normals by whole quanta; not moved one
/// time in four.
void EditAuthor::add_lowered(OwnedEdit& edit, const std::vector<std::uint32_t>& sources)
{
    const FinestMesh& mesh = soup_.source();
    Vec3 normal(0.0, 0.0, 0.0);
    for (const std::uint32_t source : sources)
    {
        normal += normal_of(corners_[source]);
    }
    const double depth = random_.one_in(4) ? 0.0 : random_.between(1.0, 800.0);
    const Vec3 way = normal.norm() > 0.0 ? Vec3(-depth * normal.normalized()) : Vec3(0, 0, 0);
    for (const std::uint32_t source : sources)
    {
        Face face = corners_[source];
        for (Vec3f& corner : face)
        {
            std::array<std::int64_t, 3> quanta{};
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                quanta[axis] = std::llround(corner[axis] / mesh.quantum_m) +
                               std::llround(way[static_cast<Eigen::Index>(axis)]);
            }
            corner = mesh.corner_at(quanta);
        }
        if (!has_equal_corners(face) && !add(edit, face, mesh.faces[source].bucket))
        {
            return;
        }
    }
}

/// Random triangles; one in ten has its corners on a line.
void EditAuthor::add_triangles(OwnedEdit& edit, const Vec3& near_m)
{
    const double half_m = random_.between(0.002, 0.02) * soup_.model().diagonal_m;
    const std::uint32_t count = 1 + random_.below(12U);
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const Vec3 place_m = near_m + random_.in_cube(2.0 * half_m);
        Face face = any_triangle(place_m, half_m);
        if (random_.one_in(10))
        {
            face[2] = on_line(soup_.source(), face);
        }
        if (has_equal_corners(face))
        {
            continue;
        }
        const bool is_far_bucket = random_.one_in(8);
        if (!add(edit, face,
                 is_far_bucket ? bucket_near(place_for_edit(near_m)) : bucket_near(place_m)))
        {
            return;
        }
    }
}

/// The place itself half of the time, otherwise one anywhere on the source.
Vec3 EditAuthor::place_for_edit(const Vec3& near_m)
{
    return random_.one_in(2) ? near_m : middle_of(corners_[random_.below(corners_.size())]);
}

std::uint32_t EditAuthor::bucket_near(const Vec3& place_m)
{
    return soup_.source().faces[tree_.nearest(place_m).face].bucket;
}

std::uint32_t EditAuthor::used_slots_after(const OwnedEdit& edit) const
{
    const auto freed =
        std::ranges::count_if(edit.removed, [this](FaceId face)
                              { return face.value >= soup_.source().counts.face_ids(); });
    return static_cast<std::uint32_t>(soup_.added().size() + edit.added.size()) -
           static_cast<std::uint32_t>(freed);
}

} // namespace tactus::test
