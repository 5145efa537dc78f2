// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Part of a run that a complaint is about.
enum class RunPart : std::uint8_t
{
    scene,      ///< Mesh, scene and their servers.
    controller, ///< This program, its options and devices.
    machine,    ///< Machine of the loop.
};

/// Undesired event or state of a run.
struct Complaint
{
    RunPart part;
    std::string words;
    bool is_loss{false}; ///< True for a loss or an empty result; --strict makes it a failure.

    [[nodiscard]] bool operator==(const Complaint&) const = default;
};

/// Complaints on a run; empty if there are none.
[[nodiscard]] std::vector<Complaint> complaints_of(const nlohmann::ordered_json& report);

[[nodiscard]] bool has_loss(std::span<const Complaint> complaints) noexcept;

/// True if no complaint concerns the scene or the controller.
[[nodiscard]] bool is_machine_alone(std::span<const Complaint> complaints) noexcept;

/// Text "ok", or the verdict on scene, controller and machine separately.
[[nodiscard]] std::string verdict_text(std::span<const Complaint> complaints);

/// Text on the limit that most frames of the run reached, with their number and the remedy, such as
/// "no room for faces (forest_full in 12 frames): --pool-mib 8, 4 times as much". Empty if no limit
/// was reached.
[[nodiscard]] std::string limit_text(const nlohmann::ordered_json& report);

} // namespace tactus::hrtc
