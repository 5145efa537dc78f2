// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tactus
{

/// Splits records of a decoded model one by one from the base mesh, without caches. Checks every
/// rule of the format that the controller's linker checks, and that the fans close. 16 B a face of
/// the source.
class Replay
{
public:
    /// Starts at the base mesh. The model must outlive the Replay.
    explicit Replay(const DecodedModel& model);

    /// Splits a record. Refused with a reason, and nothing changed, if its star is not the expected
    /// one: a dependency was not split, or the model is inconsistent.
    [[nodiscard]] std::optional<std::string> split(RecordId id);

    [[nodiscard]] std::uint32_t face_count() const noexcept { return face_count_; }
    [[nodiscard]] bool is_active(FaceId face) const noexcept
    {
        return !faces_[face.value].corners[0].is_none();
    }
    [[nodiscard]] const std::array<VertexId, 3>& corners(FaceId face) const noexcept
    {
        return faces_[face.value].corners;
    }
    [[nodiscard]] FaceState state(FaceId face) const noexcept { return faces_[face.value].state; }

    /// The present mesh in the source's frame, in metres; vertices and faces in the order of their
    /// ids, unused vertices omitted.
    [[nodiscard]] TriangleMesh mesh() const;

private:
    struct Face
    {
        std::array<VertexId, 3> corners{}; ///< Corners; none while the face is not active.
        FaceState state{};
    };
    /// Vertices w0 .. wk around the vertex of a split, in canonical order of rt_core/spm/page.hpp.
    using Ring = std::array<VertexId, kMaxFanFaces + 1>;

    [[nodiscard]] std::optional<std::string> walk_fan(RecordId id, Ring& ring) const;
    [[nodiscard]] std::uint32_t depth_of(FaceState state) const;

    const DecodedModel& model_;
    ModelCounts counts_;
    std::vector<Face> faces_;
    std::uint32_t face_count_;
};

/// All records, each after its dependencies: by depth, then by number.
[[nodiscard]] std::vector<RecordId> in_dependency_order(const DecodedModel& model);

/// All records, the most important first. The importance is the largest bound of the fan before the
/// split, of the record and of all its dependents. Every prefix of the list can be split.
[[nodiscard]] std::vector<RecordId> coarsest_first(const DecodedModel& model);

} // namespace tactus
