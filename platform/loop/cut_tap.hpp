// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/model_id.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/tool_force.hpp"
#include "rt_core/scene/object_table.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// One frame of a tool that presses on an object, in the frame of the object's model.
struct CutSample
{
    std::uint32_t tool{0};
    std::uint32_t object{0};
    ModelId model{};
    std::int64_t time_ns{0};
    double scale{1.0};               ///< Scale of the object: metres of the world for one.
    std::array<double, 3> proxy_m{}; ///< Tool's origin at the proxy.
    std::array<double, 4> rotation{0.0, 0.0, 0.0,
                                   1.0}; ///< Rotation of the proxy: unit quaternion x, y, z, w.
    std::array<double, 3> push{};        ///< Direction from the proxy to the device, of length 1.
    double force_n{0.0};                 ///< Force that the device renders, at most the spring's.
};

/// Data of one frame from which the samples are made.
struct CutFrame
{
    std::int64_t time_ns{0};
    const FrameOutput& output;
    std::span<const ToolForce> forces;
    std::span<const double> radii_m;
    const ObjectTable& objects;
};

/// Passes the contacts of tools that cut from the haptic thread to the transport thread, in a queue
/// of fixed size. Neither waits: samples that find the queue full are dropped and counted.
class CutTap
{
public:
    /// Capacity in samples, for two seconds of two tools.
    static constexpr std::size_t kSamples = 4'096;

    /// `cutting` has bit n set if tool n cuts.
    explicit CutTap(std::uint32_t cutting) : cutting_(cutting), cells_(kSamples), samples_(cells_)
    {
    }

    /// Haptic thread, after the forces are written: a sample for each tool that cuts and touches
    /// an object, with that of its least distance. Allocates nothing.
    void show(const CutFrame& frame) noexcept;

    /// Transport thread: moves the oldest sample into the argument; false if there is none.
    [[nodiscard]] bool try_take(CutSample& sample) noexcept { return samples_.try_pop(sample); }

    /// Any thread: number of dropped samples.
    [[nodiscard]] std::uint64_t lost() const noexcept
    {
        return lost_.load(std::memory_order_relaxed);
    }

private:
    std::uint32_t cutting_;
    std::vector<CutSample> cells_;
    SpscQueue<CutSample> samples_;
    std::atomic<std::uint64_t> lost_{0}; ///< Relaxed: for display only.
};

} // namespace tactus::hrtc
