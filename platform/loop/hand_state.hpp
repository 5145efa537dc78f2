// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/local_surface.hpp"
#include "rt_core/records/safety.hpp"
#include "rt_core/records/tool_force.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

// Any thread: values, and functions of their arguments alone; only text_of() allocates.
namespace tactus
{

/// Reason why a hand gets less than the force of the surface. Of several reasons at once, the one
/// that lasts longest; HandState::causes has all that the force pipeline knows.
enum class Withheld : std::uint8_t
{
    nothing,   ///< The hand gets the whole force.
    no_frame,  ///< No frame has run yet.
    ended,     ///< The loop has ended, or the hand or its World is gone.
    no_sample, ///< The device has given no valid sample yet.
    /// The tool overlaps an object that came round it or round which it came: no force of this
    /// object until the two are clear of each other. HandState::withheld_object has its number.
    overlap,
    // Below in the order of ForceOff's bits.
    velocity,
    watchdog,
    software,
    disconnect,
    deadman,
    stale,
    garbage,
    stall,
    server,
    assertion,
    jump,
    halted,
    over_constrained,
    clutch,
    starved,
    growth,
};
inline constexpr std::size_t kWithhelds = 21;
static_assert(static_cast<std::size_t>(Withheld::growth) + 1 == kWithhelds);

/// One line on the reason and on the condition for the force to return; empty for
/// Withheld::nothing. Allocates.
[[nodiscard]] std::string text_of(Withheld withheld);

/// Reason for these causes; nothing if there is none.
[[nodiscard]] Withheld withheld_by(ForceOff causes) noexcept;

/// Bounds and nearest points of a tool and one object near it, for the tool at the proxy's place at
/// the start of the frame. World frame, SI.
struct HandContact
{
    std::uint32_t object{0}; ///< Number of the object (Object::number()).
    AnswerKind kind{AnswerKind::bounded};
    bool is_touched{false}; ///< True if the tool may touch the object in this frame.
    /// Bounds of the distance from the tool's core to the object: the radius is not subtracted. The
    /// upper bound is infinite if unknown.
    double lower_m{0.0};
    double upper_m{0.0};
    std::array<double, 3> on_tool_m{};   ///< Nearest point of the tool's core.
    std::array<double, 3> on_object_m{}; ///< Nearest point of the object, of an exact answer.
};

/// Largest number of contacts in a HandState; of more objects, those with the least lower bounds. A
/// corner of three objects holds a sphere.
inline constexpr std::size_t kHandContacts = 4;

/// State of one hand after a frame. World frame, SI; rotations are unit quaternions x, y, z, w.
struct HandState
{
    std::uint64_t frame{0};             ///< Number of frames run; 0: none.
    std::array<double, 3> force_n{};    ///< Force sent to the device.
    std::array<double, 3> torque_nm{};  ///< Torque sent to the device, about its position.
    std::array<double, 3> position_m{}; ///< Position of the tool at the device's pose.
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};
    /// Position of the proxy: where surfaces allow the tool to be.
    std::array<double, 3> proxy_m{};
    std::array<double, 4> proxy_rotation{0.0, 0.0, 0.0, 1.0};
    bool in_contact{false};
    /// True if the tool was inside a closed object in the first frame: its surface keeps the tool
    /// inside.
    bool began_inside{false};
    Withheld withheld{Withheld::no_frame};
    std::uint32_t withheld_object{0};       ///< Number of the object of Withheld::overlap.
    ForceOff causes{ForceOff::none};        ///< All causes known to the force pipeline.
    ForceAction actions{ForceAction::none}; ///< Limits that changed the force.
    SafetyState safety{SafetyState::reset};
    std::uint32_t buttons{0};       ///< Bit n: button n of the device is pressed.
    std::uint32_t contact_count{0}; ///< Number of used contacts.
    /// Objects near the tool, the one with the least lower bound first.
    std::array<HandContact, kHandContacts> contacts{};
};
static_assert(std::is_trivially_copyable_v<HandState>);

} // namespace tactus
