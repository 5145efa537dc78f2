// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/controller.hpp"
#include "platform/loop/refinement_state_tap.hpp"
#include "platform/machine/time.hpp"
#include "platform/scene/scene_keeper.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/front.hpp"

#include <atomic>
#include <cstdint>
#include <memory>

namespace tactus::hrtc
{

/// Completes a copy by data from this side of the tap, such as the models and tools of its numbers.
/// `before` are the times of the copy before, for the means. Objects that `keeper` knows get their
/// hosts' names; it may be null. The chunk loader supplies the requested chunks. Transport thread;
/// allocates.
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

    /// Connects the haptic thread's tap, before the first step. The tap lives as long as the run.
    void connect(RefinementStateTap& tap) noexcept { tap_ = &tap; }

    /// Sends the newest refinement state if one is due and available. While no viewer watches, the
    /// copy isn't given back, so the haptic thread makes no other.
    void step(MonotonicTime now, const SceneKeeper* keeper);

    /// Marks that the tool began inside a closed object. Any thread.
    void tell_begins_inside(std::size_t tool) noexcept
    {
        begin_inside_.fetch_or(1U << tool, std::memory_order_relaxed); // Pairs with none.
    }

    [[nodiscard]] std::uint64_t sent() const noexcept { return writer_->sent(); }

private:
    explicit RefinementStateSender(const Controller& controller) : controller_(controller) {}

    const Controller& controller_;
    std::unique_ptr<dds::RefinementStateWriter> writer_;
    RefinementStateTap* tap_{nullptr};
    static_assert(kMaxTools <= 32);
    std::atomic<std::uint32_t> begin_inside_{0}; ///< One bit a tool.
    RefinementStateCopy::AllTimes last_{};
    MonotonicTime last_sent_{};
    bool is_old_{true}; ///< True if the present copy was made before a viewer watched.
};

} // namespace tactus::hrtc
