// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/hand_tap.hpp"

#include "platform/devices/device_force.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/object_touch.hpp"

#include <algorithm>

namespace tactus::hrtc
{

namespace
{

static_assert(kMaxTools <= 32); // One bit each in begins_inside_.

std::array<double, 4> quaternion_of(const Mat3& rotation) noexcept
{
    const Eigen::Quaterniond q(rotation);
    return {q.x(), q.y(), q.z(), q.w()};
}

HandContact contact_of(const PairOutput& pair, const ToolOutput& output, double radius_m) noexcept
{
    return {pair.object,
            pair.kind,
            may_touch(pair, output, radius_m),
            pair.lower_m,
            pair.upper_m,
            to_array(pair.point_m),
            to_array(pair.nearest_point_m)};
}

/// Puts the pair among the contacts, in order of the lower bounds.
void add_contact(HandState& state, const PairOutput& pair, const ToolOutput& output,
                 double radius_m) noexcept
{
    auto* const begin = state.contacts.begin();
    auto* const end = begin + state.contact_count;
    auto* const at = std::find_if(
        begin, end, [&pair](const HandContact& contact) { return pair.lower_m < contact.lower_m; });
    if (at == state.contacts.end())
    {
        return;
    }
    state.contact_count =
        std::min(state.contact_count + 1, static_cast<std::uint32_t>(kHandContacts));
    auto* const last = begin + state.contact_count - 1;
    std::move_backward(at, last, last + 1);
    *at = contact_of(pair, output, radius_m);
}

void take_pairs(HandState& state, const HandFrame& frame, std::uint32_t tool) noexcept
{
    const double radius_m = frame.radii_m[tool];
    state.contact_count = 0;
    for (const PairOutput& pair : frame.output.pairs)
    {
        if (pair.tool != tool)
        {
            continue;
        }
        add_contact(state, pair, frame.output.tools[tool], radius_m);
        if (!pair.is_joined && state.withheld == Withheld::nothing && is_in_reach(pair, radius_m))
        {
            state.withheld = Withheld::overlap;
            state.withheld_object = pair.object;
        }
    }
}

Withheld withheld_of(const ToolOutput& output, const ToolForce& force) noexcept
{
    const Withheld by_cause = withheld_by(force.causes);
    if (by_cause != Withheld::nothing)
    {
        return by_cause;
    }
    return output.is_gone                      ? Withheld::ended
           : force.state == SafetyState::reset ? Withheld::no_sample
                                               : Withheld::nothing;
}

} // namespace

HandTap::HandTap(std::size_t tools)
    : last_(tools)
    // NOLINTNEXTLINE(*-avoid-c-arrays)
    , mailboxes_(std::make_unique<Mailbox<HandState>[]>(tools))
{
    TACTUS_ASSERT(tools <= kMaxTools);
}

void HandTap::show(const HandFrame& frame) noexcept
{
    const std::uint32_t inside = begins_inside_.load(std::memory_order_relaxed);
    for (std::uint32_t tool = 0; tool < last_.size(); ++tool)
    {
        const ToolState& read = frame.tools[tool];
        const ToolOutput& output = frame.output.tools[tool];
        const ToolForce& force = frame.forces[tool];
        HandState& state = last_[tool];
        state.frame = frame.frame + 1;
        state.force_n = to_array(force.push.force_n + force.load_n);
        state.torque_nm = to_array(force.torque.force_n + force.load_nm);
        state.position_m = to_array(read.position_m);
        state.rotation = quaternion_of(read.rotation);
        state.proxy_m = to_array(output.proxy_m);
        state.proxy_rotation = quaternion_of(output.proxy_rotation);
        state.in_contact = output.in_contact;
        state.began_inside = (inside >> tool & 1U) != 0;
        state.withheld = withheld_of(output, force);
        state.causes = force.causes;
        state.actions = force.push.actions | force.torque.actions;
        state.safety = force.state;
        state.buttons = frame.devices[tool].buttons;
        take_pairs(state, frame, tool);
        mailboxes_[tool].write(state);
    }
    counts_.write(frame.counts);
    has_frame_.store(true, std::memory_order_relaxed);
}

HandState HandTap::state(std::size_t tool) const noexcept
{
    HandState state;
    while (has_frame_.load(std::memory_order_relaxed) && !mailboxes_[tool].try_read(state))
    {
        // The writer lost its processor in the middle of a write; it will have it again. Only a
        // writer that ends there would keep a reader here, and a thread does not end alone.
    }
    state.began_inside =
        state.began_inside || (begins_inside_.load(std::memory_order_relaxed) >> tool & 1U) != 0;
    return state;
}

LoopCounts HandTap::counts() const noexcept
{
    LoopCounts counts;
    while (has_frame_.load(std::memory_order_relaxed) && !counts_.try_read(counts))
    {
        // The writer lost its processor; see state().
    }
    return counts;
}

void HandTap::note_begins_inside(std::size_t tool) noexcept
{
    begins_inside_.fetch_or(1U << tool, std::memory_order_relaxed);
}

} // namespace tactus::hrtc
