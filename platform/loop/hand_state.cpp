// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/hand_state.hpp"

#include <algorithm>
#include <bit>

namespace tactus
{

namespace
{

constexpr std::size_t kFirstCause = static_cast<std::size_t>(Withheld::velocity);
static_assert(kWithhelds == kFirstCause + kForceOffs);

/// Causes by weight: those that need somebody to act first, momentary ones last.
constexpr auto kByWeight = std::to_array<ForceOff>(
    {ForceOff::assertion, ForceOff::software, ForceOff::disconnect, ForceOff::deadman,
     ForceOff::clutch, ForceOff::server, ForceOff::starved, ForceOff::over_constrained,
     ForceOff::halted, ForceOff::garbage, ForceOff::stale, ForceOff::velocity, ForceOff::watchdog,
     ForceOff::jump, ForceOff::stall, ForceOff::growth});
static_assert(kByWeight.size() == kForceOffs);

} // namespace

std::string text_of(Withheld withheld)
{
    switch (withheld)
    {
    case Withheld::nothing:
        return {};
    case Withheld::no_frame:
        return "no frame has run yet; the force begins with the first frame";
    case Withheld::ended:
        return "the loop has ended, or the hand is gone";
    case Withheld::no_sample:
        return "the device has not been read yet; the force returns with the first valid sample";
    case Withheld::overlap:
        return "the tool overlaps an object since one of the two came; no force until it is clear";
    default:
        break;
    }
    const ForceOffWords& words = kForceOffWords[static_cast<std::size_t>(withheld) - kFirstCause];
    return std::string(words.why) + "; the force returns " + words.back;
}

Withheld withheld_by(ForceOff causes) noexcept
{
    if (causes == ForceOff::none)
    {
        return Withheld::nothing;
    }
    const auto* const first =
        std::ranges::find_if(kByWeight, [causes](ForceOff one) { return has_cause(causes, one); });
    const auto bit = static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(*first)));
    return static_cast<Withheld>(kFirstCause + bit);
}

} // namespace tactus
