// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/records/safety.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/ids.hpp"
#include "transport/pose.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Any thread: values; those with vectors allocate.
namespace tactus
{

/// Page slots that one front looks at: of 256 Ki records, 33 MB of pages.
inline constexpr std::size_t kMaxFrontPages = 4'096;
/// Object numbers that one front looks at, beside the objects of awake pairs.
inline constexpr std::uint32_t kFrontSweep = 16;
/// Most objects of one front.
inline constexpr std::size_t kMaxFrontObjects = 2 * kFrontSweep;
/// Most wishes of one front, those of all models together: a courier has no more open.
inline constexpr std::size_t kMaxFrontWishes = 256;
/// Most regions of one front; a ball that moves has five.
inline constexpr std::size_t kMaxFrontRegions = 64;
/// Most bytes of FrontTool::shape.
inline constexpr std::size_t kMaxShapeBytes = 63;

/// A resident page of records. A record is split where its bit is set: base mesh and split records
/// are the faces that the controller has, to the last one.
struct FrontPage
{
    ChunkId chunk{};
    std::uint64_t refined{0}; ///< Bit n: the chunk's record n.

    bool operator==(const FrontPage&) const = default;
};

/// A model of which the controller has something.
struct FrontModel
{
    ContentHash hash{};
    std::vector<FrontPage> pages; ///< By their chunks.
    std::vector<ChunkId> wished;  ///< Asked for and not here yet; ascending.

    bool operator==(const FrontModel&) const = default;
};

/// A ball that a tool may touch: where its chunks are looked for. Model frame, metres.
struct FrontRegion
{
    std::uint32_t model{0};  ///< Of Front::models.
    bool is_foretold{false}; ///< Else a tool is there.
    std::array<float, 3> center_m{};
    float radius_m{0.0F};

    bool operator==(const FrontRegion&) const = default;
};

/// Where an object stood at the end of the frame.
struct FrontObject
{
    std::uint64_t host_epoch{0}; ///< As in PairTelemetry.
    std::uint32_t object{0};     ///< Likewise.
    std::uint32_t number{0};     ///< On the controller.
    std::uint32_t model{0};      ///< Of Front::models.
    Pose pose;                   ///< Of the model's frame (ModelHeader::origin_m), in the world.

    bool operator==(const FrontObject&) const = default;
};

/// With the controller's own number of the model.
[[nodiscard]] inline FrontRegion front_region_of(const RankedRegion& region) noexcept
{
    FrontRegion shown{
        region.model.value, region.lead_ns > 0, {}, static_cast<float>(region.radius_m)};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        shown.center_m[axis] = static_cast<float>(region.center_m[static_cast<int>(axis)]);
    }
    return shown;
}

struct FrontTool
{
    SafetyState state{SafetyState::reset};
    ForceOff causes{ForceOff::none}; ///< Why less than the frame's force goes out.
    std::string shape;               ///< In the words of hrtc's --tool; printable ASCII.
    double radius_m{0.0};
    bool begins_inside{false}; ///< It began inside a closed object.

    bool operator==(const FrontTool&) const = default;
};

/// Times of frames, in nanoseconds.
struct FrontTimes
{
    double mean_ns{0.0}; ///< Of the frames since the last front.
    double max_ns{0.0};  ///< Of all frames.

    bool operator==(const FrontTimes&) const = default;
};

/// Stages in their order, then the frame, then its processor time.
inline constexpr std::size_t kFrontTimes = kStages + 2;

/// What a controller has refined, and how, at most ten times a second: what a viewer needs beside
/// Telemetry to draw the controller's own faces from a copy of the model.
struct Front
{
    std::uint64_t frame{0}; ///< Frames run.
    std::int64_t time_ns{0};
    std::array<FrontTimes, kFrontTimes> times{};
    Budgets budgets; ///< Of the frame.
    /// Of the numbers from here up to `sweep_end` on the controller all objects are listed.
    std::uint32_t sweep_begin{0};
    std::uint32_t sweep_end{0};
    std::uint32_t slots_left_out{0};   ///< Of pages, beyond kMaxFrontPages.
    std::uint32_t regions_left_out{0}; ///< Less urgent ones, beyond kMaxFrontRegions.
    std::vector<FrontTool> tools;
    std::vector<FrontModel> models; ///< Those with pages or wishes, of `objects` or `regions`.
    std::vector<FrontObject> objects;
    std::vector<FrontRegion> regions; ///< Most urgent first.

    bool operator==(const Front&) const = default;
};

} // namespace tactus
