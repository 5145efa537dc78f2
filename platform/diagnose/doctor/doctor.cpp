// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/doctor.hpp"

#include "platform/diagnose/doctor/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace tactus::doctor
{

namespace
{

/// One check of the machine.
struct Check
{
    const char* name; ///< Lower-case words joined by '-'.
    const char* why;  ///< Effect on the loop if the check finds a problem.
    Finding (*run)(const MachineView&);
};

/// All checks, in the order of display.
constexpr Check kChecks[] = {
    {"priority",
     "Without SCHED_FIFO, the loop waits for other threads, for milliseconds. hrtc then runs only "
     "with --allow-no-rt.",
     check_priority},
    {"memlock",
     "A page that is not locked may have to be loaded during a frame. Memory that is mapped later "
     "counts too, so no finite limit is enough.",
     check_memory_lock},
    {"clock-source",
     "The loop reads the clock several times in each frame. A read through the vDSO takes 20 ns; "
     "any other read is a system call, which frames must not make.",
     check_clock_source},
    {"timer",
     "Without high-resolution timers, a thread wakes only at the kernel's tick, every 1 to 10 ms. "
     "A period of 1 ms is then impossible.",
     check_timer},
    {"float-control",
     "A library, for example one built with -ffast-math, changes the floating-point mode (FTZ, "
     "DAZ, rounding) of all threads. Results then have other bits, and bounds are no longer "
     "proven.",
     check_float_control},
    {"preemption",
     "The loop waits while another thread is in a part of the kernel that can't be preempted. "
     "PREEMPT_RT has few such parts and runs interrupts in threads.",
     check_preemption},
    {"rt-throttling",
     "Real-time threads that use up their share are paused for the rest of the period, even "
     "during a contact. Without the limit, a thread in an endless loop keeps its processor.",
     check_throttling},
    {"compaction",
     "A thread that accesses a page during its move waits until the end of the move. This is a "
     "page fault, although the memory of the loop is locked.",
     check_compaction},
    {"isolation",
     "On an isolated processor, the caches of the loop stay warm, and other threads and the "
     "kernel's housekeeping do not run.",
     check_isolation},
    {"interrupts",
     "An interrupt on the loop's processor pauses the loop. A network card causes thousands of "
     "interrupts a second.",
     check_interrupts},
    {"governor",
     "The loop works for a small part of each period. Other governors take this for idle time and "
     "lower the clock rate, so that frames take longer.",
     check_governor},
    {"idle-states",
     "The processor sleeps between frames. Each wake-up from a deep C-state is late by the exit "
     "latency of that state, and caches may be cold.",
     check_idle_states},
    {"smt",
     "Two processors of one core share its execution units and caches. Work on the other "
     "processor makes frames take longer, and the loop can't prevent this.",
     check_siblings},
    {"huge-pages",
     "With 'always', the kernel also merges small pages in use, and an access waits for the "
     "merge. hrtc requests huge pages where it needs them.",
     check_huge_pages},
    {"dds-configuration",
     "Without CYCLONEDDS_URI, hrtc finds only models of this machine (interface lo, no "
     "multicast). With CYCLONEDDS_URI, DDS uses that configuration unchanged.",
     check_dds_configuration},
    {"dds-interface",
     "If the interface does not exist, is down or has no link, hrtc gets models only from files.",
     check_dds_interface},
    {"dds-buffers",
     "A burst of chunks larger than the buffer of the socket is lost and sent again. Until then, "
     "answers stay bounded. DDS requests 1 MiB for receiving and 64 KiB for sending.",
     check_dds_buffers},
};

} // namespace

std::vector<Finding> examine(const MachineView& view)
{
    std::vector<Finding> findings;
    for (const Check& check : kChecks)
    {
        Finding& finding = findings.emplace_back(check.run(view));
        finding.name = check.name;
        finding.why = check.why;
    }
    return findings;
}

std::size_t count_of(const std::vector<Finding>& findings, Verdict verdict)
{
    return static_cast<std::size_t>(std::ranges::count(findings, verdict, &Finding::verdict));
}

namespace
{

using Json = nlohmann::ordered_json;

constexpr std::size_t kColumns = 100;
constexpr std::size_t kIndent = 29;

/// Breaks the text between words; lines after the first begin at kIndent.
std::string wrapped(std::string_view text)
{
    const std::size_t most = kColumns - kIndent;
    std::string lines;
    while (text.size() > most)
    {
        std::size_t end = text.rfind(' ', most);
        end = end == std::string_view::npos || end == 0 ? most : end;
        lines += fmt::format("{}\n{:{}}", text.substr(0, end), "", kIndent);
        text.remove_prefix(text[end] == ' ' ? end + 1 : end);
    }
    return lines + std::string(text);
}

std::string block_of(const Finding& finding)
{
    std::string block =
        fmt::format("{:<9} {:<18} {}\n{:{}}{}\n", name_of(finding.verdict), finding.name,
                    wrapped(finding.found), "", kIndent, wrapped(finding.why));
    for (const std::string& command : finding.remedy)
    {
        block += fmt::format("{:{}}$ {}\n", "", kIndent, command);
    }
    return block;
}

/// Verdicts in the order of display, the worst first.
constexpr std::array kShown{Verdict::critical, Verdict::unknown, Verdict::advice, Verdict::good};

std::string counts_in_words(const std::vector<Finding>& findings)
{
    std::string text;
    for (const Verdict verdict : kShown)
    {
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count_of(findings, verdict),
                            name_of(verdict));
    }
    return text;
}

/// Line with the names of the good findings.
std::string good_ones(const std::vector<Finding>& findings)
{
    std::string names;
    for (const Finding& finding : findings)
    {
        if (finding.verdict == Verdict::good && !finding.is_asked_for)
        {
            names += (names.empty() ? "" : ", ") + finding.name;
        }
    }
    return names.empty()
               ? ""
               : fmt::format("\n{:<9} {:<18} {}\n", name_of(Verdict::good), "", wrapped(names));
}

} // namespace

Json make_report(const std::vector<Finding>& findings, std::optional<int> cpu)
{
    Json counts = Json::object();
    for (std::size_t i = 0; i < kVerdictNames.size(); ++i)
    {
        counts[kVerdictNames[i]] = count_of(findings, static_cast<Verdict>(i));
    }
    Json checks = Json::array();
    for (const Finding& finding : findings)
    {
        checks.push_back({{"name", finding.name},
                          {"verdict", name_of(finding.verdict)},
                          {"found", finding.found},
                          {"why", finding.why},
                          {"remedy", finding.remedy}});
    }
    Json report{{"schema", 1}, {"cpu", nullptr}, {"counts", counts}, {"checks", checks}};
    if (cpu)
    {
        report["cpu"] = *cpu;
    }
    return report;
}

std::string make_text(const std::vector<Finding>& findings, bool shows_good)
{
    std::string text = counts_in_words(findings) + '\n';
    for (const Verdict verdict : kShown)
    {
        for (const Finding& finding : findings)
        {
            const bool is_shown = verdict != Verdict::good || shows_good || finding.is_asked_for;
            if (finding.verdict == verdict && is_shown)
            {
                text += '\n' + block_of(finding);
            }
        }
    }
    return text + (shows_good ? "" : good_ones(findings));
}

} // namespace tactus::doctor
