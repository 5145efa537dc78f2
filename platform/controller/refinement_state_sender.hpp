// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/refinement_state_tap.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/front.hpp"

#include <atomic>
#include <cstdint>
#include <memory>

namespace tactus::dds
{

class DdsClient;

} // namespace tactus::dds

namespace tactus::hrtc
{

class Controller;
class SceneKeeper;

/// Refinement state for viewers: the haptic thread's copy, completed by data of the transport
/// thread such as model hashes, tool shapes and requested chunks. Means cover the frames since
/// `before`, the times of the last copy. Objects that `keeper` follows get their server's epoch and
/// number; `keeper` may be null. Transport thread; allocates.
[[nodiscard]] RefinementState refinement_state_of(const RefinementStateCopy& copy,
                                                  const RefinementStateCopy::AllTimes& before,
                                                  const Controller& controller,
                                                  const SceneKeeper* keeper);

/// Sends the controller's refinement state on the transport thread.
class RefinementStateSender
{
public:
    /// Shortest time between two refinement states.
    static constexpr Duration kPeriod = milliseconds(100);

    /// `client` and `controller` must outlive the sender.
    [[nodiscard]] static Result<std::unique_ptr<RefinementStateSender>, Refusal>
    create(const dds::DdsClient& client, const Controller& controller);

    /// Connects the haptic thread's tap. Call it before the first step(). The tap must outlive the
    /// last step().
    void connect(RefinementStateTap& tap) noexcept { tap_ = &tap; }

    /// Sends a refinement state if kPeriod has passed since the last one, a viewer watches and a
    /// copy is there. While no viewer watches, the copy isn't given back, so the haptic thread
    /// makes no other.
    void step(MonotonicTime now, const SceneKeeper* keeper);

    /// Sets the flag of the tool that it began inside a closed object. Any thread.
    void tell_begins_inside(std::size_t tool) noexcept
    {
        begin_inside_.fetch_or(1U << tool, std::memory_order_relaxed); // Orders no other data.
    }

    [[nodiscard]] std::uint64_t sent() const noexcept { return writer_->sent(); }

private:
    explicit RefinementStateSender(const Controller& controller) : controller_(controller) {}

    const Controller& controller_;
    std::unique_ptr<dds::RefinementStateWriter> writer_;
    RefinementStateTap* tap_{nullptr};
    static_assert(kMaxTools <= 32);
    /// One bit a tool: set if the tool began inside a closed object.
    std::atomic<std::uint32_t> begin_inside_{0};
    RefinementStateCopy::AllTimes last_{};
    MonotonicTime last_sent_{};
    /// True if the present copy may be from before a viewer watched; such a copy is not sent.
    bool is_old_{true};
};

} // namespace tactus::hrtc
