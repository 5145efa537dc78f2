// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/deadline_report.hpp"

#include "platform/plot/page.hpp"
#include "platform/report/latency_chart.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tactus::hrtc
{

namespace
{

using Json = nlohmann::ordered_json;

/// Quantity reported for each phase.
struct Quantity
{
    const char* key;
    const char* title;
    LatencyHistogram DeadlinePhase::*histogram;
};
constexpr std::array kQuantities{
    Quantity{"wake", "Wake-up latency", &DeadlinePhase::wake},
    Quantity{"cpu", "Processor time of a frame", &DeadlinePhase::cpu},
    Quantity{"response", "Time from the deadline to the force, lost periods included",
             &DeadlinePhase::response},
};

/// Pairs of an upper edge in us and a count; empty bins are omitted.
Json bins_of(const LatencyHistogram& histogram)
{
    const std::vector<double> edges = edges_us(50);
    const std::vector<double> counts = counts_between(histogram, edges);
    Json bins = Json::array();
    for (std::size_t i = 0; i < counts.size(); ++i)
    {
        if (counts[i] > 0.0)
        {
            bins.push_back({edges[i + 1], static_cast<std::uint64_t>(counts[i])});
        }
    }
    return bins;
}

Json phase_of(const DeadlinePhase& phase)
{
    Json json = phase.report;
    json["load"] = phase.loads;
    for (const Quantity& quantity : kQuantities)
    {
        json["histograms_us"][quantity.key] = bins_of(phase.*quantity.histogram);
    }
    return json;
}

std::string loads_of(const DeadlinePhase& phase)
{
    return phase.loads.empty() ? phase.name
                               : fmt::format("{} ({})", phase.name, fmt::join(phase.loads, ", "));
}

std::uint64_t cycles_of(const DeadlinePhase& phase)
{
    return phase.report["frames"].get<std::uint64_t>();
}

/// Count in the deadline section of a run's report.
std::uint64_t count_of(const DeadlinePhase& phase, const char* key)
{
    return phase.report["deadline"][key].get<std::uint64_t>();
}

std::string table_of(std::span<const DeadlinePhase> phases)
{
    std::string text = fmt::format(
        "{:<12}{:>50}{:>19}{:>24}{:>17}\n"
        "{:<12}{:>8}{:>8}{:>10}{:>16}{:>8}{:>7}{:>6}{:>6}{:>8}{:>7}{:>9}{:>8}{:>9}\n",
        "", "deadlines", "cpu us", "wake us", "response us", "", "cycles", "missed", "overruns",
        "latency misses", "stopped", "p50", "p99", "max", "p50", "p99", "max", "p99", "max");
    for (const DeadlinePhase& phase : phases)
    {
        const auto us = [](const LatencyHistogram& histogram, double q)
        { return to_us(histogram.quantile(q)); };
        text += fmt::format("{:<12}{:>8}{:>8}{:>10}{:>16}{:>8}", phase.name, cycles_of(phase),
                            count_of(phase, "missed"), count_of(phase, "overrun"),
                            count_of(phase, "latency_misses"), count_of(phase, "stopped"));
        text += fmt::format("{:>7.0f}{:>6.0f}{:>6.0f}{:>8.0f}{:>7.0f}{:>9.0f}{:>8.0f}{:>9.0f}\n",
                            us(phase.cpu, 0.5), us(phase.cpu, 0.99), to_us(phase.cpu.max()),
                            us(phase.wake, 0.5), us(phase.wake, 0.99), to_us(phase.wake.max()),
                            us(phase.response, 0.99), to_us(phase.response.max()));
    }
    return text;
}

/// Table of the same figures for a page.
plot::Table figures_of(std::span<const DeadlinePhase> phases)
{
    plot::Table table{{{"", false},
                       {"cycles"},
                       {"deadlines missed"},
                       {"overruns"},
                       {"latency misses"},
                       {"stopped"},
                       {"cpu p99, us"},
                       {"wake p99, us"},
                       {"response p99, us"},
                       {"response max, us"}},
                      {}};
    const auto us = [](Duration time) { return fmt::format("{:.0f}", to_us(time)); };
    for (const DeadlinePhase& phase : phases)
    {
        std::vector<std::string>& line = table.lines.emplace_back();
        line = {loads_of(phase), fmt::format("{}", cycles_of(phase))};
        for (const char* key : {"missed", "overrun", "latency_misses", "stopped"})
        {
            line.push_back(fmt::format("{}", count_of(phase, key)));
        }
        for (const Duration time : {phase.cpu.quantile(0.99), phase.wake.quantile(0.99),
                                    phase.response.quantile(0.99), phase.response.max()})
        {
            line.push_back(us(time));
        }
    }
    return table;
}

std::string machine_line(const DeadlinePhase& phase)
{
    const Json& machine = phase.report["machine"];
    return fmt::format(
        "{}; {}; {}, {} processors; {}", machine["kernel"].get<std::string>(),
        machine["preemption"].get<std::string>(), machine["processor"].get<std::string>(),
        machine["processors"].get<unsigned>(), machine["date_utc"].get<std::string>());
}

/// Line in the form of `cyclictest`: priority, interval, cycles and latencies, times in us.
std::string cyclictest_of(const DeadlinePhase& phase, const DeadlineSetting& setting)
{
    return fmt::format("{:<12}P:{:2} I:{} C:{:7} Min:{:7.0f} Avg:{:5.0f} Max:{:8.0f}\n", phase.name,
                       setting.priority, setting.period.ns / 1'000, phase.wake.count(),
                       to_us(phase.wake.min()), phase.wake.mean_ns() * 1e-3,
                       to_us(phase.wake.max()));
}

std::string verdict_of(const SelfCheck& check, std::span<const DeadlinePhase> phases)
{
    std::uint64_t cycles = 0;
    std::uint64_t own = 0;
    for (const DeadlinePhase& phase : phases)
    {
        cycles += cycles_of(phase);
        own += count_of(phase, "overrun");
    }
    if (!check.is_passed())
    {
        return fmt::format(
            "failed: the self-check flagged {} of {}, and {} in frames without a fault; the other "
            "results are invalid; repeat the test with fewer other programs",
            check.flagged, counted(check.injected, "fault"), check.false_flags);
    }
    return fmt::format("{}: {} in {}", own == 0 ? "passed" : "failed", counted(own, "overrun"),
                       counted(cycles, "cycle"));
}

/// Bar with one '#' for each factor of 10^(1/5), at least one for any count.
std::string bar_of(double count)
{
    const auto length =
        count > 0.0 ? 1 + static_cast<std::size_t>(5.0 * std::log10(count)) : std::size_t{0};
    return std::string(length, '#');
}

} // namespace

bool is_passed(const SelfCheck& check, std::span<const DeadlinePhase> phases)
{
    return check.is_passed() && std::ranges::all_of(phases, [](const DeadlinePhase& phase)
                                                    { return count_of(phase, "overrun") == 0; });
}

Json make_deadline_report(const SelfCheck& check, std::span<const DeadlinePhase> phases)
{
    Json report = phase_of(phases.back());
    report["self_check"] = {{"injected", check.injected},
                            {"flagged", check.flagged},
                            {"false_flags", check.false_flags},
                            {"allocations_counted", check.allocations_counted},
                            {"passed", check.is_passed()}};
    report["passed"] = is_passed(check, phases);
    if (phases.size() > 1)
    {
        report["alone"] = phase_of(phases.front());
    }
    return report;
}

std::string make_deadline_summary(const SelfCheck& check, std::span<const DeadlinePhase> phases,
                                  const DeadlineSetting& setting)
{
    std::string text = "self-check  " + self_check_line(check) + '\n' + table_of(phases);
    text += "wake-up latency in the form of cyclictest, us\n";
    for (const DeadlinePhase& phase : phases)
    {
        text += cyclictest_of(phase, setting);
    }
    text += "cpu p99     share of the period: ";
    for (const DeadlinePhase& phase : phases)
    {
        const double share = static_cast<double>(phase.cpu.quantile(0.99).ns) /
                             static_cast<double>(setting.period.ns);
        text += fmt::format("{}{:.1f} % {}", &phase == phases.data() ? "" : ", ", 100.0 * share,
                            loads_of(phase));
    }
    return text + "\nverdict     " + verdict_of(check, phases) + '\n';
}

std::string make_histogram_text(std::span<const DeadlinePhase> phases)
{
    constexpr std::array kSteps{1.0, 2.0, 5.0};
    std::vector<double> edges{0.0};
    for (double decade = 1.0; decade < 1e8; decade *= 10.0)
    {
        for (const double step : kSteps)
        {
            edges.push_back(step * decade);
        }
    }
    std::string text = machine_line(phases.front()) + '\n';
    for (const Quantity& quantity : kQuantities)
    {
        std::vector<std::vector<double>> counts;
        std::size_t first = edges.size();
        std::size_t last = 0;
        for (const DeadlinePhase& phase : phases)
        {
            counts.push_back(counts_between(phase.*quantity.histogram, edges));
            for (std::size_t i = 0; i < counts.back().size(); ++i)
            {
                first = counts.back()[i] > 0.0 ? std::min(first, i) : first;
                last = counts.back()[i] > 0.0 ? std::max(last, i + 1) : last;
            }
        }
        text += fmt::format("\n{}\n{:>12}", quantity.title, "up to us");
        for (const DeadlinePhase& phase : phases)
        {
            text += fmt::format("{:>10}  {:<28}", "cycles", loads_of(phase));
        }
        text += '\n';
        for (std::size_t i = first; i < last; ++i)
        {
            text += fmt::format("{:>12.0f}", edges[i + 1]);
            for (const std::vector<double>& of_phase : counts)
            {
                text += fmt::format("{:>10.0f}  {:<28}", of_phase[i], bar_of(of_phase[i]));
            }
            text.erase(text.find_last_not_of(' ') + 1);
            text += '\n';
        }
    }
    return text;
}

std::string make_histogram_page(const SelfCheck& check, std::span<const DeadlinePhase> phases,
                                const DeadlineSetting& setting, plot::ChartLibrary library)
{
    plot::Page page("hrtc deadline-test", std::move(library));
    page.verdict(verdict_of(check, phases), is_passed(check, phases));
    page.table(figures_of(phases));
    std::vector<plot::Chart> charts;
    for (const Quantity& quantity : kQuantities)
    {
        NamedHistograms histograms;
        for (const DeadlinePhase& phase : phases)
        {
            histograms.emplace_back(loads_of(phase), &(phase.*quantity.histogram));
        }
        charts.push_back(latency_chart(quantity.title, "cycles", histograms, setting.period));
    }
    page.charts(charts);
    page.table(plot::facts(
        {{"self-check", self_check_line(check)}, {"machine", machine_line(phases.front())}}));
    return page.html();
}

} // namespace tactus::hrtc
