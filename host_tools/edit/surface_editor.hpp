// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/surface_cut.hpp"
#include "host_tools/edit/surface_faces.hpp"
#include "host_tools/edit/sweep.hpp"
#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"
#include "transport/edit_content.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

// One thread at a time, except the haptic one: calls allocate.
namespace tactus
{

/// Largest number of faces that one change of a surface removes and adds. A larger one is refused.
inline constexpr std::size_t kMaxChangedFaces = 20'000;

/// A change of a surface, in one edit or several in a row. Of several, the first ones add faces
/// and the last ones remove faces, so that no surface is missing in between.
struct SurfaceChange
{
    std::vector<EditContent> edits; ///< None if nothing changed.
    /// Volume that the solid lost (carve) or gained (fill, displace). Of an open surface, that
    /// between the old and the new faces; approximate at its border.
    double volume_m3{0.0};
};

/// The surface of a model while it is edited: source faces that are left, and added faces. 140 B a
/// face of the source and of the room, and at most 24 x kMaxMarks B an added face. A change takes
/// time for the faces near its region only.
///
/// The surface bounds a solid, on the back of its faces. An open surface bounds a solid, too, near
/// the edit: below its border, walls against the faces' normals are imagined. Bodies that overlap
/// are edited as if each were alone.
///
/// After a change, the surface is closed if it was closed before: the oriented edges of all faces
/// cancel by position. New vertices are rounded to the grid.
///
/// After a cut, the new faces and the added faces round them are merged: vertices are removed as
/// long as the surface stays within SweptRegion::slack_quanta of all points that were removed
/// before, however many edits lie between (merge_pieces()). An edit has only faces that differ.
///
/// A refused call changes nothing. Its text is one line with the value and the allowed range.
class SurfaceEditor
{
public:
    /// Starts from a sound model at full resolution, with revision 0 and no added faces. `room` is
    /// the number of slots for added faces; refused above kMaxAddedFaces.
    [[nodiscard]] static Result<SurfaceEditor, Refusal> create(const DecodedModel& model,
                                                               std::uint32_t room);

    /// Takes the sweep's region from the solid. A region wholly inside a closed solid leaves a
    /// void.
    [[nodiscard]] Result<SurfaceChange, Refusal> carve(const Sweep& sweep);
    /// Joins the sweep's region to the solid. New faces must lie in the model's box.
    [[nodiscard]] Result<SurfaceChange, Refusal> fill(const Sweep& sweep);
    /// Moves vertices within `radius_m` of `center_m` by `vector_m` x (1 - d^2 / radius^2)^2, where
    /// d is a vertex's distance from the center. All in the source's frame.
    [[nodiscard]] Result<SurfaceChange, Refusal> displace(const Vec3& center_m, double radius_m,
                                                          const Vec3& vector_m);

    /// Number of the last edit.
    [[nodiscard]] std::uint32_t revision() const noexcept { return revision_; }
    [[nodiscard]] std::uint32_t face_count() const noexcept { return faces_.count(); }
    [[nodiscard]] std::uint32_t added_count() const noexcept
    {
        return room_ - static_cast<std::uint32_t>(free_slots_.size());
    }
    [[nodiscard]] std::uint32_t room() const noexcept { return room_; }
    /// The present surface in the source's frame, in metres; vertices of equal position are one.
    [[nodiscard]] TriangleMesh surface() const;

private:
    /// A change before it is checked: ids of faces that go, and faces that come.
    struct Plan
    {
        std::vector<std::uint32_t> removed;
        std::vector<SurfaceFace> added;
    };

    SurfaceEditor(const DecodedModel& model, std::uint32_t room, std::uint32_t typical_size);

    [[nodiscard]] Result<SurfaceChange, Refusal> cut(const Sweep& sweep, CutSense sense);
    [[nodiscard]] std::optional<Plan> plan_cut(const SweptRegion& region, CutSense sense) const;
    /// Gives the marks of cut faces to the nearest of their pieces. A mark that is far from all
    /// pieces was cut off.
    void hand_down_marks(const SurfaceCut& cut, const std::vector<std::uint32_t>& near,
                         double slack_quanta, std::vector<SurfaceFace>& added) const;
    void merge(Plan& plan, double slack_quanta) const;
    [[nodiscard]] std::optional<int> winding_of(const Vec3& point) const;
    void add_walls(const GridBox& region, std::vector<CutFace>& faces) const;
    [[nodiscard]] Vec3 normal_at(const GridPoint& point) const;
    [[nodiscard]] std::uint32_t bucket_near(const GridTriangle& face,
                                            const std::vector<std::uint32_t>& nearby) const;
    [[nodiscard]] std::optional<Refusal> fault_of(const Plan& plan) const;
    [[nodiscard]] Result<SurfaceChange, Refusal> apply(Plan plan);
    [[nodiscard]] double volume_quanta(const Plan& plan) const;
    [[nodiscard]] AddedFace added_face(std::uint32_t slot, const SurfaceFace& face) const;

    SurfaceGrid grid_;
    GridPoint extent_{};
    bool is_closed_{false};
    std::uint32_t source_ids_{0};
    std::uint32_t room_{0};
    std::uint32_t revision_{0};
    SurfaceFaces faces_;
    std::vector<std::uint32_t> free_slots_; ///< A heap, the lowest slot first.
};

} // namespace tactus
