// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/finding.hpp"
#include "platform/diagnose/doctor/measured.hpp"
#include "platform/diagnose/doctor/system_files.hpp"
#include "platform/diagnose/doctor/system_text.hpp"

#include <optional>
#include <string>

namespace tactus::doctor
{

/// The machine as the checks see it.
struct MachineView
{
    const SystemFiles& files;
    const Measured& measured;
    std::optional<int> cpu; ///< The processor that the loop is to be pinned to; none: not chosen.
};

/// Processors that are on; none when the kernel does not tell.
[[nodiscard]] std::optional<ProcessorSet> online_processors(const SystemFiles& files);

/// Where the loop will run: the chosen processor, else all that are on.
[[nodiscard]] std::optional<ProcessorSet> loop_processors(const MachineView& view);

/// What `--cpu` is or should best be: the chosen one, else the highest that is on.
[[nodiscard]] std::optional<int> chosen_or_highest(const MachineView& view);

/// "processors 0-3", "processor 2".
[[nodiscard]] std::string processors_in_words(const ProcessorSet& set);

/// The check can't tell, since `path` can't be read or has something else in it.
[[nodiscard]] Finding unreadable(Finding finding, const SystemFiles& files,
                                 const std::string& path);

/// Adds arguments to the kernel's line, for good, as Debian does it.
[[nodiscard]] std::string add_to_kernel_line(const std::string& arguments);

} // namespace tactus::doctor
