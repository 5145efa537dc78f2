// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/surface_edit.hpp"
#include "rt_core/spm/header.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/stability/tool_oracle.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace tactus::test
{

/// Face of a model's finest mesh.
struct SourceFace
{
    FaceId id{};
    std::uint32_t bucket{0};
    Face corners{};
};

/// Finest mesh of a model with the ids of its faces, ascending, and the grid of the model.
struct FinestMesh
{
    std::vector<SourceFace> faces;
    std::vector<std::vector<std::uint32_t>> neighbours; ///< Faces with a common corner, by face.
    ModelCounts counts;
    float quantum_m{0.0F};
    std::array<std::uint32_t, 3> extent_quanta{};

    [[nodiscard]] Vec3f corner_at(const std::array<std::int64_t, 3>& quanta) const;
};

/// Finest mesh of a model, found once for each model and process. Its corners are compared with
/// those of the quantised source; a difference ends the program with a line.
[[nodiscard]] const FinestMesh& finest_mesh(const TestModel& model);

/// SurfaceEdit that owns its faces.
struct OwnedEdit
{
    std::uint32_t revision{0};
    std::vector<FaceId> removed;
    std::vector<AddedFace> added;
    Aabb removed_m;

    [[nodiscard]] SurfaceEdit view(ModelId model = ModelId{0}) const
    {
        return {model, revision, removed, added, removed_m};
    }
};

/// Truth about an edited model: the list of its faces, from the source and the edits alone.
class EditedSoup
{
public:
    /// Starts with the source. The model must outlive the soup.
    EditedSoup(const TestModel& model, std::uint32_t room);

    /// Applies a valid edit of this soup; an invalid one ends the program with a line.
    void apply(const OwnedEdit& edit);

    [[nodiscard]] const FinestMesh& source() const { return source_; }
    [[nodiscard]] std::uint32_t revision() const { return revision_; }
    [[nodiscard]] std::uint32_t room() const { return room_; }
    [[nodiscard]] std::uint32_t added_max() const { return added_max_; }
    [[nodiscard]] const std::map<std::uint32_t, AddedFace>& added() const { return added_; }
    /// Removed and present source faces, as places in FinestMesh::faces.
    [[nodiscard]] bool is_here(std::uint32_t face) const { return is_here_[face]; }
    [[nodiscard]] std::uint32_t sources_here() const { return sources_here_; }
    [[nodiscard]] FaceId id_of_slot(std::uint32_t slot) const
    {
        return {source_.counts.face_ids() + slot};
    }

    /// Faces as a model, in an order of their own.
    [[nodiscard]] const TestModel& model() const { return soup_; }
    [[nodiscard]] bool is_empty() const { return soup_.faces.empty(); }
    /// Place of a face in model().faces; none if the face is not part of the surface.
    [[nodiscard]] std::optional<std::uint32_t> place_of(FaceId face) const;
    /// Distances from these faces, of which there must be one.
    [[nodiscard]] const CenterOracle& oracle() const { return *oracle_; }

private:
    void list_faces();

    const FinestMesh& source_;
    std::uint32_t room_;
    std::vector<bool> is_here_;
    std::uint32_t sources_here_;
    std::map<std::uint32_t, std::uint32_t> place_of_source_; ///< Places in `source_` by id.
    std::map<std::uint32_t, AddedFace> added_;               ///< Added faces by slot.
    std::uint32_t revision_{0};
    std::uint32_t added_max_{0};
    TestModel soup_;
    std::map<std::uint32_t, std::uint32_t> places_; ///< Places in `soup_` by id.
    std::optional<CenterOracle> oracle_;
};

/// Random edits of a soup, valid ones and ones that must be refused.
class EditAuthor
{
public:
    /// Both arguments must outlive the author.
    EditAuthor(const EditedSoup& soup, Random& random);

    /// Valid next edit, often near a place.
    [[nodiscard]] OwnedEdit next(const Vec3& near_m);
    /// Edit with valid contents that must be refused for one reason; none if the surface does not
    /// permit such an edit. `too_many` and `unknown_model` do not depend on the edit.
    [[nodiscard]] std::optional<OwnedEdit> bad(EditRefusal reason, const Vec3& near_m);

    /// Random triangle in the model's box, in a cube round a place.
    [[nodiscard]] Face any_triangle(const Vec3& near_m, double half_m);
    /// Edit that removes these source faces, places in FinestMesh::faces.
    [[nodiscard]] OwnedEdit removal_of(const std::vector<std::uint32_t>& sources) const;
    /// Adds a face to the first free slot, or to a random one of the lowest; false if there is
    /// none.
    bool add(OwnedEdit& edit, const Face& corners, std::uint32_t bucket) const;
    /// Present source faces, nearest to a place first in the sense of common corners.
    [[nodiscard]] std::vector<std::uint32_t> patch(const Vec3& near_m, std::size_t count) const;

private:
    [[nodiscard]] std::vector<std::uint32_t> scatter(std::size_t count);
    [[nodiscard]] std::vector<std::uint32_t> region(const Vec3& near_m);
    void remove_added(OwnedEdit& edit);
    void add_lowered(OwnedEdit& edit, const std::vector<std::uint32_t>& sources);
    void add_triangles(OwnedEdit& edit, const Vec3& near_m);
    [[nodiscard]] Vec3 place_for_edit(const Vec3& near_m);
    [[nodiscard]] std::uint32_t bucket_near(const Vec3& place_m);
    [[nodiscard]] std::uint32_t used_slots_after(const OwnedEdit& edit) const;

    const EditedSoup& soup_;
    Random& random_;
    std::vector<Face> corners_; ///< Corners of the source faces, for the tree.
    FaceTree tree_;             ///< Tree of the source.
};

} // namespace tactus::test
