// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/doctor.hpp"
#include "tests/unit/doctor/doctor_cases.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string_view>

namespace tactus::doctor
{
namespace
{

/// Checks that depend only on trials.
constexpr std::array<std::string_view, 5> kWithoutFiles{"priority", "memlock", "timer",
                                                        "float-control", "dds-configuration"};

bool is_clean(const std::string& text)
{
    return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= 0x20 && c < 0x7F; });
}

/// Expectations of every finding on every machine.
void expect_sound(const std::vector<Finding>& findings)
{
    std::set<std::string> names;
    for (const Finding& finding : findings)
    {
        SCOPED_TRACE(finding.name);
        EXPECT_TRUE(names.insert(finding.name).second);
        EXPECT_TRUE(is_clean(finding.found)) << finding.found;
        EXPECT_TRUE(is_clean(finding.why));
        EXPECT_EQ(finding.remedy.empty(), finding.verdict == Verdict::good) << finding.found;
        EXPECT_TRUE(std::ranges::all_of(finding.remedy, is_clean));
    }
    EXPECT_EQ(findings.size(), 17U);
}

void expect_unknown_where_files_tell(const std::vector<Finding>& findings)
{
    for (const Finding& finding : findings)
    {
        const bool has_files = std::ranges::count(kWithoutFiles, finding.name) == 0;
        EXPECT_EQ(finding.verdict == Verdict::unknown, has_files)
            << finding.name << ": " << finding.found;
    }
}

TEST(Examine, has_nothing_to_say_against_a_good_machine)
{
    MadeUpMachine machine;
    make_good(machine);
    const std::vector<Finding> findings = examine(machine.view());
    expect_sound(findings);
    for (const Finding& finding : findings)
    {
        EXPECT_EQ(finding.verdict, Verdict::good) << finding.name << ": " << finding.found;
    }
    EXPECT_EQ(count_of(findings, Verdict::good), 17U);
}

TEST(Examine, says_of_a_machine_without_files_what_is_missing)
{
    MadeUpMachine machine;
    machine.measured.clock_resolution_ns = 1;
    for (const std::optional<int> cpu : {std::optional<int>(), std::optional(0)})
    {
        machine.cpu = cpu;
        const std::vector<Finding> findings = examine(machine.view());
        expect_sound(findings);
        expect_unknown_where_files_tell(findings);
        for (const Finding& finding : findings)
        {
            EXPECT_TRUE(finding.verdict == Verdict::good ||
                        finding.found.ends_with(" does not exist"))
                << finding.found;
        }
    }
}

/// Every file of a good machine has the same garbage.
TEST(Examine, takes_garbage_for_nothing_good)
{
    const std::string huge(1 << 20, '9');
    for (const std::string& garbage :
         {std::string(), std::string("\n"), std::string("-"), std::string("\xff\xfe\0\x1b[2J", 8),
          std::string(","), std::string("0x"), std::string(5000, ','), std::string(70'000, '('),
          huge})
    {
        SCOPED_TRACE(garbage.substr(0, 8));
        MadeUpMachine machine;
        make_good(machine);
        machine.measured.kernel_version = "";
        machine.measured.clock_calls.reset();
        for (const std::string& path : machine.paths())
        {
            machine.put(path, garbage);
        }
        const std::vector<Finding> findings = examine(machine.view());
        expect_sound(findings);
        expect_unknown_where_files_tell(findings);
    }
}

TEST(Examine, survives_bytes_at_random)
{
    const unsigned seed = 20260102;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    MadeUpMachine machine;
    make_good(machine);
    const std::vector<std::string> paths = machine.paths();
    const std::string letters = "0123456789,-()[]<>abcfx/ \n\x80";
    for (int i = 0; i < 100; ++i)
    {
        for (const std::string& path : paths)
        {
            std::string bytes(random() % 12, '\0');
            std::ranges::generate(bytes, [&] { return letters[random() % letters.size()]; });
            machine.put(path, bytes);
        }
        machine.cpu = i % 2 == 0 ? std::optional(static_cast<int>(random() % 1024)) : std::nullopt;
        expect_sound(examine(machine.view()));
    }
}

std::vector<std::string> split(const std::string& text, const std::string& by)
{
    const auto trimmed = [](std::string part)
    {
        part.erase(0, part.find_first_not_of(' '));
        part.erase(part.find_last_not_of(' ') + 1);
        return part;
    };
    std::vector<std::string> parts;
    std::size_t from = 0;
    for (std::size_t at = text.find(by); at != std::string::npos; at = text.find(by, from))
    {
        parts.push_back(trimmed(text.substr(from, at - from)));
        from = at + by.size();
    }
    parts.push_back(trimmed(text.substr(from)));
    return parts;
}

/// Text with the characters for \n, \t, \0, \\ and \xNN.
std::string unescaped(const std::string& text)
{
    std::string letters;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        if (text[i] != '\\')
        {
            letters += text[i];
            continue;
        }
        const char code = text.at(++i);
        const bool is_hexadecimal = code == 'x';
        letters += is_hexadecimal ? static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16))
                   : code == 'n'  ? '\n'
                   : code == 't'  ? '\t'
                   : code == '0'  ? '\0'
                                  : code;
        i += is_hexadecimal ? 2 : 0;
    }
    return letters;
}

std::string path_of(const std::string& name)
{
    static const std::map<std::string, std::string> kPlaces{
        {"@clock/", "/sys/devices/system/clocksource/clocksource0/"},
        {"@core/", "/proc/sys/net/core/"},
        {"@cpu/", "/sys/devices/system/cpu/"},
        {"@huge", "/sys/kernel/mm/transparent_hugepage/enabled"},
        {"@idle/", "/sys/devices/system/cpu/cpu3/cpuidle/"},
        {"@irq/", "/proc/irq/"},
        {"@kernel/", "/proc/sys/kernel/"},
        {"@limits", "/etc/security/limits.d/tactus.conf"},
        {"@net/", "/sys/class/net/"}};
    for (const auto& [from, to] : kPlaces)
    {
        if (name.starts_with(from))
        {
            return to + name.substr(from.size());
        }
    }
    return name;
}

template <typename T>
std::optional<T> number_or_none(const std::string& text)
{
    return text == "none" ? std::nullopt : std::optional(static_cast<T>(std::stoll(text)));
}

void set_measured(MadeUpMachine& machine, const std::string& name, const std::string& value)
{
    Measured& measured = machine.measured;
    const std::map<std::string, std::function<void()>> setters{
        {"cpu", [&] { machine.cpu = number_or_none<int>(value); }},
        {"calls", [&] { measured.clock_calls = number_or_none<std::uint64_t>(value); }},
        {"resolution", [&] { measured.clock_resolution_ns = number_or_none<std::int64_t>(value); }},
        {"rtprio", [&] { measured.rtprio_limit = number_or_none<std::uint64_t>(value); }},
        {"memlock", [&] { measured.memlock_limit = number_or_none<std::uint64_t>(value); }},
        {"fifo", [&] { measured.fifo_refused = value; }},
        {"float", [&] { measured.float_control_is_default = value != "changed"; }},
        {"lock", [&] { measured.memory_lock_granted = value != "refused"; }},
        {"machine", [&] { measured.machine = value; }},
        {"preloaded", [&] { measured.preloaded = value; }},
        {"uri", [&] { measured.dds_uri = value; }},
        {"user", [&] { measured.user = value; }},
        {"version", [&] { measured.kernel_version = value; }}};
    setters.at(name)();
}

/// Makes one change with its value number `choice`; returns the number of values.
std::size_t change(MadeUpMachine& machine, const std::string& text, std::size_t choice)
{
    const std::size_t sign = text.find('=');
    const std::string name = text.substr(0, sign);
    if (sign == std::string::npos)
    {
        name.starts_with('-') ? machine.take_away(path_of(name.substr(1)))
                              : machine.put_folder(path_of(name));
        return 1;
    }
    const std::vector<std::string> values = split(text.substr(sign + 1), "%");
    const std::string value = unescaped(values.at(std::min(choice, values.size() - 1)));
    if (name.starts_with('~'))
    {
        const std::string folder = "/sys/class/net/" + name.substr(1);
        machine.put(folder + "/flags", value.substr(0, value.find(' ')));
        machine.put(folder + "/operstate", value.substr(value.find(' ') + 1));
    }
    else if (name.starts_with('/') || name.starts_with('@'))
    {
        machine.put(path_of(name), value);
    }
    else
    {
        set_measured(machine, name, value);
    }
    return values.size();
}

bool matches(const std::string& text, std::string pattern)
{
    const bool is_open_before = pattern.starts_with("...");
    const bool is_open_behind = pattern.size() > 3 && pattern.ends_with("...");
    pattern = pattern.substr(is_open_before ? 3 : 0);
    pattern = pattern.substr(0, pattern.size() - (is_open_behind ? 3 : 0));
    return pattern == "*" ||
           (is_open_before && is_open_behind && text.find(pattern) < text.size()) ||
           (is_open_before && text.ends_with(pattern)) ||
           (is_open_behind && text.starts_with(pattern)) || text == pattern;
}

Finding finding_of(const MadeUpMachine& machine, const std::string& check)
{
    const std::vector<Finding> findings = examine(machine.view());
    expect_sound(findings);
    const auto found = std::ranges::find(findings, check, &Finding::name);
    if (found == findings.end())
    {
        ADD_FAILURE() << "there is no check " << check;
        return {};
    }
    if (found->verdict == Verdict::critical) // This change alone.
    {
        EXPECT_EQ(count_of(findings, Verdict::good), findings.size() - 1);
    }
    return *found;
}

void expect_left(const MadeUpMachine& machine, const std::string& check, const std::string& left)
{
    const std::size_t sign = left.find('=');
    if (sign == std::string::npos)
    {
        EXPECT_EQ(finding_of(machine, check).verdict, Verdict::good) << "the remedy is none";
        return;
    }
    EXPECT_EQ(machine.content_of(path_of(left.substr(0, sign))), unescaped(left.substr(sign + 1)));
}

/// Good machine that is restored after each case, since creating one takes many files.
struct GoodMachine
{
    GoodMachine()
    {
        make_good(machine);
        measured = machine.measured;
        cpu = machine.cpu;
        for (const std::string& path : machine.paths())
        {
            files[path] = machine.content_of(path);
        }
    }
    [[nodiscard]] bool has_any_in(const std::string& folder) const
    {
        const auto next = files.lower_bound(folder + "/");
        return next != files.end() && next->first.starts_with(folder + "/");
    }
    /// Restores this path or folder, and removes folders that were created for it.
    void restore(std::string place)
    {
        for (std::string folder = place; !folder.empty() && !has_any_in(folder);
             folder.erase(folder.rfind('/')))
        {
            place = folder;
        }
        if (machine.files().is_there(place))
        {
            machine.take_away(place);
        }
        for (const auto& [path, content] : files)
        {
            if (path == place || path.starts_with(place + "/"))
            {
                machine.put(path, content);
            }
        }
    }
    void restore(const std::vector<std::string>& changes)
    {
        machine.measured = measured;
        machine.cpu = cpu;
        for (const std::string& text : changes)
        {
            const std::string name = text.substr(text.starts_with('-') ? 1 : 0, text.find('='));
            const std::string path =
                name.starts_with('~') ? "/sys/class/net/" + name.substr(1) : path_of(name);
            if (path.starts_with('/'))
            {
                restore(path.substr(0, path.find_last_not_of('/') + 1));
            }
        }
    }

    MadeUpMachine machine;
    Measured measured;
    std::optional<int> cpu;
    std::map<std::string, std::string> files;
};

/// Tries a case with value number `choice` of each change; returns the number of values.
std::size_t try_case(GoodMachine& good, const std::vector<std::string>& parts, std::size_t choice)
{
    MadeUpMachine& machine = good.machine;
    const std::vector<std::string> changes = split(parts[1], ";;");
    std::size_t choices = 1;
    for (const std::string& text : changes)
    {
        choices = text.empty() ? choices : std::max(choices, change(machine, text, choice));
    }
    const Finding sut = finding_of(machine, parts[0]);
    EXPECT_EQ(name_of(sut.verdict), parts[2]) << sut.found;
    EXPECT_TRUE(parts[3].empty() || matches(sut.found, parts[3])) << sut.found;
    std::vector<std::string> remedies = split(parts[4], ";;");
    const bool has_others = remedies.back().empty() || remedies.back() == "...";
    remedies.resize(remedies.size() - (has_others ? 1 : 0));
    EXPECT_TRUE(has_others ? sut.remedy.size() >= remedies.size()
                           : sut.remedy.size() == remedies.size())
        << sut.remedy.size();
    for (std::size_t i = 0; i < std::min(remedies.size(), sut.remedy.size()); ++i)
    {
        const bool is_run = remedies[i].starts_with('!');
        EXPECT_TRUE(matches(sut.remedy[i], unescaped(remedies[i].substr(is_run ? 1 : 0))))
            << sut.remedy[i];
        if (is_run)
        {
            machine.run(sut.remedy[i]);
        }
    }
    for (const std::string& left : split(parts[5], ";;"))
    {
        if (!left.empty())
        {
            expect_left(machine, parts[0], left);
        }
    }
    good.restore(changes);
    return choices;
}

TEST(Examine, makes_of_each_machine_what_the_cases_say)
{
    std::set<std::string> checks;
    std::set<std::string> critical;
    std::string text;
    std::istringstream lines(kDoctorCases);
    for (std::string line; std::getline(lines, line);)
    {
        text += line.starts_with(' ') ? line.substr(4) : "\n" + line;
    }
    GoodMachine good;
    std::istringstream cases(text);
    for (std::string line; std::getline(cases, line);)
    {
        if (line.empty())
        {
            continue;
        }
        SCOPED_TRACE(line);
        std::vector<std::string> parts = split(line, "=>");
        ASSERT_LE(parts.size(), 6U);
        parts.resize(6);
        checks.insert(parts[0]);
        if (parts[2] == "critical")
        {
            critical.insert(parts[0]);
        }
        for (std::size_t choice = 0, choices = 1; choice < choices; ++choice)
        {
            choices = try_case(good, parts, choice);
        }
    }
    EXPECT_EQ(checks.size(), 17U);
    EXPECT_EQ(critical, (std::set<std::string>{"clock-source", "dds-configuration", "dds-interface",
                                               "float-control", "memlock", "priority",
                                               "rt-throttling", "timer"}))
        << "what the loop can not be without";
}

TEST(Examine, only_advises_where_the_loop_runs_all_the_same)
{
    MadeUpMachine machine;
    make_good(machine);
    machine.take_away("/sys/kernel/realtime");
    machine.put("/proc/version", "Linux version 6.1 #1 SMP PREEMPT_DYNAMIC");
    machine.put("/proc/sys/kernel/sched_rt_runtime_us", "950000");
    machine.put("/proc/sys/vm/compact_unevictable_allowed", "1");
    machine.put("/sys/devices/system/cpu/isolated", "");
    machine.put("/proc/irq/default_smp_affinity", "f");
    machine.put("/sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "powersave");
    machine.put("/sys/devices/system/cpu/cpu3/cpuidle/state1/latency", "890");
    machine.put("/sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "2-3");
    machine.put("/sys/kernel/mm/transparent_hugepage/enabled", "[always] madvise never");
    machine.put("/proc/sys/net/core/rmem_max", "212992");
    const std::vector<Finding> findings = examine(machine.view());
    expect_sound(findings);
    EXPECT_EQ(count_of(findings, Verdict::advice), 10U);
    EXPECT_EQ(count_of(findings, Verdict::good), 7U);
}

} // namespace
} // namespace tactus::doctor
