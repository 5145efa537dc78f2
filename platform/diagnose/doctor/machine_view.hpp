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

/// Data on the machine for the checks.
struct MachineView
{
    const SystemFiles& files;
    const Measured& measured;
    std::optional<int> cpu; ///< Processor that the loop will be pinned to; none: not chosen.
};

/// Online processors; none if the kernel does not report them.
[[nodiscard]] std::optional<ProcessorSet> online_processors(const SystemFiles& files);

/// Processors of the loop: the chosen one, or all online ones.
[[nodiscard]] std::optional<ProcessorSet> loop_processors(const MachineView& view);

/// Processor given by `--cpu`; otherwise the highest online one, the best choice for `--cpu`. None
/// if unknown.
[[nodiscard]] std::optional<int> chosen_or_highest(const MachineView& view);

/// Text like "processors 0-3" or "processor 2".
[[nodiscard]] std::string processors_in_words(const ProcessorSet& set);

/// Finding with the verdict unknown, because `path` can't be read or has invalid content.
[[nodiscard]] Finding unreadable(Finding finding, const SystemFiles& files,
                                 const std::string& path);

/// Command that adds arguments to the kernel's line permanently, in Debian's way.
[[nodiscard]] std::string add_to_kernel_line(const std::string& arguments);

} // namespace tactus::doctor
