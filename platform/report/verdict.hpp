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

/// What a complaint is about.
enum class RunPart : std::uint8_t
{
    scene,      ///< Mesh, scene and those who serve them.
    controller, ///< This program, its options and devices.
    machine,    ///< What the loop runs on.
};

/// Something that no user wants to see of a run.
struct Complaint
{
    RunPart part;
    std::string words;
    bool is_loss{
        false}; ///< Something was lost or came to nothing: with --strict the run has failed.

    [[nodiscard]] bool operator==(const Complaint&) const = default;
};

/// None when the run was as it should be.
[[nodiscard]] std::vector<Complaint> complaints_of(const nlohmann::ordered_json& report);

[[nodiscard]] bool has_loss(std::span<const Complaint> complaints) noexcept;

/// Whether neither mesh and scene nor the controller is complained of.
[[nodiscard]] bool is_machine_alone(std::span<const Complaint> complaints) noexcept;

/// "ok", or mesh and scene, controller and machine judged apart.
[[nodiscard]] std::string verdict_text(std::span<const Complaint> complaints);

} // namespace tactus::hrtc
