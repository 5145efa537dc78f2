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

/// Adds what only this side of the tap knows: which models and tools the numbers mean.
/// `before` are the times of the copy before, for the means; objects are named as the hosts do
/// where `keeper`, which may be none, knows them, and the chunk loader tells what is requested. The
/// transport thread; allocates.
[[nodiscard]] RefinementState refinement_state_of(const RefinementStateCopy& copy,
                                                  const RefinementStateCopy::AllTimes& before,
                                                  const Controller& controller,
                                                  const SceneKeeper* keeper);

/// Sends the controller's refinement state. On the transport thread.
class RefinementStateSender
{
public:
    /// The shortest time between two refinement states.
    static constexpr Duration kPeriod = milliseconds(100);

    /// `client` and `controller` must outlive it.
    [[nodiscard]] static Result<std::unique_ptr<RefinementStateSender>, Refusal>
    create(const dds::DdsClient& client, const Controller& controller);

    /// To the haptic thread, before the first step; the tap lives as long as the run.
    void connect(RefinementStateTap& tap) noexcept { tap_ = &tap; }

    /// Sends the newest refinement state when one is due and there. While no viewer watches, the
    /// copy stays out, so that the haptic thread makes none.
    void step(MonotonicTime now, const SceneKeeper* keeper);

    /// Any thread.
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
    std::atomic<std::uint32_t> begin_inside_{0}; ///< A bit a tool.
    RefinementStateCopy::AllTimes last_{};
    MonotonicTime last_sent_{};
    bool is_old_{true}; ///< The copy that is out was made before anybody watched.
};

} // namespace tactus::hrtc
