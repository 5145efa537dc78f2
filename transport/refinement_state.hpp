// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/records/safety.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Any thread: these are values; those with vectors allocate.
namespace tactus
{

/// Maximum number of page slots in one refinement state: 256 Ki records, 33 MB of pages.
inline constexpr std::size_t kMaxStatePages = 4'096;
/// Maximum number of requests in one refinement state, over all models; no fewer than a ChunkLoader
/// keeps open.
inline constexpr std::size_t kMaxStateRequests = 256;
/// Maximum number of regions in one refinement state. A tool with one sphere has five.
inline constexpr std::size_t kMaxStateRegions = 64;
/// Maximum number of bytes of RefinementStateTool::shape.
inline constexpr std::size_t kMaxShapeBytes = 63;

/// A resident page of 64 records and the records that are split. The base mesh and all split
/// records determine the controller's faces exactly.
struct RefinementStatePage
{
    ChunkId chunk{};
    std::uint64_t refined{0}; ///< Bit n is set if record n of the chunk is split.

    bool operator==(const RefinementStatePage&) const = default;
};

/// A model with pages or open requests on the controller.
struct RefinementStateModel
{
    ContentHash hash{};
    std::vector<RefinementStatePage> pages; ///< Resident pages, ascending by chunk.
    std::vector<ChunkId> requested; ///< Requested chunks that are not resident yet, ascending.

    bool operator==(const RefinementStateModel&) const = default;
};

/// Sphere in the model's frame that a tool may reach; the chunks needed there are requested.
struct RefinementStateRegion
{
    std::uint32_t model{0}; ///< Index into RefinementState::models.
    /// False: around the tool's present place; true: around a predicted one.
    bool is_predicted{false};
    std::array<float, 3> center_m{};
    float radius_m{0.0F};

    bool operator==(const RefinementStateRegion&) const = default;
};

/// Region in its reported form. `model` is the controller's model number, not yet an index.
[[nodiscard]] inline RefinementStateRegion shown_region_of(const RankedRegion& region) noexcept
{
    RefinementStateRegion shown{
        region.model.value, region.horizon_ns > 0, {}, static_cast<float>(region.radius_m)};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        shown.center_m[axis] = static_cast<float>(region.center_m[static_cast<int>(axis)]);
    }
    return shown;
}

/// A tool on the controller, and the state of its force.
struct RefinementStateTool
{
    SafetyState state{SafetyState::reset};
    /// Reasons why the output is below the force that the frame computed.
    ForceOff causes{ForceOff::none};
    std::string shape; ///< Shape in the form of hrtc's --tool option; a printable_line().
    double radius_m{0.0};
    bool begins_inside{false}; ///< True if the tool began inside a closed object.

    bool operator==(const RefinementStateTool&) const = default;
};

/// Durations of one stage or of the frame, in nanoseconds.
struct FrontTimes
{
    double mean_ns{0.0}; ///< Mean since the last refinement state.
    double max_ns{0.0};  ///< Maximum over all frames.

    bool operator==(const FrontTimes&) const = default;
};

/// Number of timed spans: each stage in order, then the whole frame, then the frame's CPU time.
inline constexpr std::size_t kFrontTimes = kStages + 2;

/// Refinement state of a controller: a part of its telemetry, at most ten times a second. A viewer
/// with the model draws the controller's own faces from it.
struct RefinementState
{
    std::uint64_t frame{0}; ///< Number of frames run.
    std::array<FrontTimes, kFrontTimes> times{};
    Budgets budgets;                 ///< Budgets of the frame.
    std::uint32_t slots_left_out{0}; ///< Number of page slots omitted beyond kMaxStatePages.
    /// Number of regions omitted beyond kMaxStateRegions, those of lowest priority.
    std::uint32_t regions_left_out{0};
    std::vector<RefinementStateTool> tools;
    std::vector<RefinementStateModel> models;   ///< Models with pages, requests or regions.
    std::vector<RefinementStateRegion> regions; ///< Regions, highest priority first.

    bool operator==(const RefinementState&) const = default;
};

} // namespace tactus
