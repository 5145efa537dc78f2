// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/web/prometheus_text.hpp"

#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

namespace tactus::web
{

namespace
{

struct Metric
{
    const char* name;
    const char* type;
    const char* help;
    std::function<double(const Telemetry&)> value;
};

double largest_force_n(const Telemetry& telemetry)
{
    double most_n = 0.0;
    for (const ToolTelemetry& tool : std::span(telemetry.tools).first(telemetry.tool_count))
    {
        most_n = std::max(most_n, std::hypot(tool.force_n[0], tool.force_n[1], tool.force_n[2]));
    }
    return most_n;
}

const std::vector<Metric>& metrics()
{
    const auto count = [](std::uint64_t Telemetry::*which)
    { return [which](const Telemetry& t) { return static_cast<double>(t.*which); }; };
    static const std::vector<Metric> all{
        {"tactus_frames_total", "counter", "Frames computed.", count(&Telemetry::frame)},
        {"tactus_frames_exact_total", "counter", "Frames with exact answers.",
         count(&Telemetry::exact)},
        {"tactus_frames_separated_total", "counter", "Frames with separated answers.",
         count(&Telemetry::separated)},
        {"tactus_frames_within_tolerance_total", "counter", "Frames with answers within tolerance.",
         count(&Telemetry::within_tolerance)},
        {"tactus_frames_bounded_total", "counter", "Frames with bounded answers.",
         count(&Telemetry::bounded)},
        {"tactus_frames_stale_total", "counter", "Frames with a stale answer.",
         count(&Telemetry::stale)},
        {"tactus_deadlines_missed_total", "counter", "Missed deadlines.",
         count(&Telemetry::missed)},
        {"tactus_deadlines_overruns_total", "counter",
         "Overruns of the haptic loop, with or without a missed deadline.",
         count(&Telemetry::overruns)},
        {"tactus_deadlines_latency_misses_total", "counter", "Missed deadlines without an overrun.",
         count(&Telemetry::latency_misses)},
        {"tactus_force_newtons", "gauge", "Largest present force on a device.", largest_force_n},
        {"tactus_tools_in_contact", "gauge", "Tools in contact at present.",
         [](const Telemetry& t)
         {
             return static_cast<double>(std::ranges::count_if(
                 std::span(t.tools).first(t.tool_count), &ToolTelemetry::in_contact));
         }}};
    return all;
}

std::string escaped(const std::string& value)
{
    std::string text;
    for (const char c : value)
    {
        text += c == '\\' || c == '"' ? "\\" : "";
        c == '\n' ? text += "\\n" : text += c;
    }
    return text;
}

} // namespace

void PrometheusText::family(const char* name, const char* type, const char* help)
{
    name_ = name;
    fmt::format_to(std::back_inserter(text_), "# HELP {0} {1}\n# TYPE {0} {2}\n", name, help, type);
}

void PrometheusText::sample(const Labels& labels, double value)
{
    text_ += name_;
    for (std::size_t i = 0; i < labels.size(); ++i)
    {
        fmt::format_to(std::back_inserter(text_), "{}{}=\"{}\"", i == 0 ? "{" : ",",
                       labels[i].first, escaped(labels[i].second));
    }
    fmt::format_to(std::back_inserter(text_), "{} {}\n", labels.empty() ? "" : "}", value);
}

void tell_controllers(PrometheusText& text,
                      const std::vector<const dds::WatchedController*>& controllers)
{
    text.family("tactus_controllers", "gauge", "Controllers on the domain.");
    text.sample({}, static_cast<double>(controllers.size()));
    for (const Metric& metric : metrics())
    {
        text.family(metric.name, metric.type, metric.help);
        for (const dds::WatchedController* controller : controllers)
        {
            text.sample({{"controller", controller->name}, {"id", hash_text(controller->id)}},
                        metric.value(controller->telemetry));
        }
    }
}

} // namespace tactus::web
