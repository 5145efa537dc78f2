// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/machine_view.hpp"

#include <fmt/format.h>

namespace tactus::doctor
{

std::optional<ProcessorSet> online_processors(const SystemFiles& files)
{
    const auto list = files.text("/sys/devices/system/cpu/online");
    const auto online = list ? parse_processor_list(*list) : std::nullopt;
    return online && online->any() ? online : std::nullopt;
}

std::optional<ProcessorSet> loop_processors(const MachineView& view)
{
    return view.cpu ? std::optional(set_of(*view.cpu)) : online_processors(view.files);
}

std::optional<int> chosen_or_highest(const MachineView& view)
{
    if (view.cpu)
    {
        return view.cpu;
    }
    const auto online = online_processors(view.files);
    return online ? highest_of(*online) : std::nullopt;
}

std::string processors_in_words(const ProcessorSet& set)
{
    return fmt::format("processor{} {}", set.count() == 1 ? "" : "s", processor_list(set));
}

Finding unreadable(const SystemFiles& files, const std::string& path)
{
    Finding finding{.verdict = Verdict::unknown};
    const auto text = files.text(path);
    if (!files.is_there(path))
    {
        finding.found = fmt::format("{} does not exist", path);
    }
    else if (!text)
    {
        finding.found = fmt::format("{} can't be read", path);
    }
    else
    {
        finding.found = fmt::format("{} has the invalid content {}", path, shown(*text));
    }
    finding.remedy = {
        fmt::format("{} {}", files.is_there(path) && !text ? "sudo cat" : "ls -l", path)};
    return finding;
}

std::string add_to_kernel_line(const std::string& arguments)
{
    return fmt::format("sudo sed -i 's/^GRUB_CMDLINE_LINUX=\"/&{} /' /etc/default/grub && sudo "
                       "update-grub && sudo reboot",
                       arguments);
}

} // namespace tactus::doctor
