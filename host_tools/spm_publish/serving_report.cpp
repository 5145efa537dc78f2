// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/serving_report.hpp"

#include "platform/program/run_program.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <unistd.h>

namespace tactus
{

namespace
{

constexpr auto kTerminalPeriod = std::chrono::milliseconds(250);
constexpr auto kPlainPeriod = std::chrono::seconds(5);

} // namespace

ServingReport::ServingReport()
    : is_terminal_(::isatty(STDOUT_FILENO) == 1 && !log_style().is_json &&
                   is_logged(LogLevel::info))
{
}

ServingReport::~ServingReport()
{
    clear_line();
}

void ServingReport::print_line(const std::string& line, LogLevel level)
{
    if (!is_logged(level))
    {
        return;
    }
    clear_line();
    // Without the program's name, which begins lines of level error: a fault of one controller is
    // no failure of the program.
    const LogLevel shown = log_style().is_json ? level : LogLevel::info;
    print_out(log_text(log_style(), shown, "spm_publish", line, std::chrono::system_clock::now()) +
              '\n');
}

void ServingReport::update(const dds::DdsServer& server)
{
    const auto now = Clock::now();
    const std::chrono::duration<double> passed = now - last_;
    if (passed < (is_terminal_ ? std::chrono::nanoseconds(kTerminalPeriod) : kPlainPeriod))
    {
        return;
    }
    const auto counters = server.counters();
    const bool has_sent = counters.pieces_sent != shown_.pieces_sent;
    const std::string line = rates(server, passed.count());
    last_ = now;
    shown_ = counters;
    if (is_terminal_)
    {
        clear_line();
        print_out(line);
        line_length_ = line.size();
    }
    else if (has_sent)
    {
        print_line(line);
    }
}

std::string ServingReport::rates(const dds::DdsServer& server, double seconds) const
{
    const auto counters = server.counters();
    const auto pieces = static_cast<double>(counters.pieces_sent - shown_.pieces_sent);
    const auto bytes = static_cast<double>(counters.bytes_sent - shown_.bytes_sent);
    return fmt::format("{}, {:.0f} chunks/s, {:.1f} KB/s, {} in all",
                       counted(server.subscribers().size(), "controller"), pieces / seconds,
                       bytes / seconds / 1e3, counted(counters.pieces_sent, "chunk"));
}

void ServingReport::clear_line()
{
    if (line_length_ > 0)
    {
        print_out(fmt::format("\r{:{}}\r", "", line_length_));
        line_length_ = 0;
    }
}

namespace
{

constexpr auto kWatchPeriod = std::chrono::seconds(1);

std::string tool_text(const ToolTelemetry& tool)
{
    const auto& n = tool.force_n;
    const char* state = tool.halted             ? " halted"
                        : tool.over_constrained ? " over-constrained"
                        : tool.in_contact       ? " in contact"
                                                : "";
    const auto& nm = tool.torque_nm;
    std::string text = fmt::format("; {:.2f} N", std::hypot(n[0], n[1], n[2]));
    if (const double torque_nm = std::hypot(nm[0], nm[1], nm[2]); torque_nm > 0.0)
    {
        text += fmt::format(" {:.3f} N m", torque_nm);
    }
    if (tool.has_gripper)
    {
        text += fmt::format(" gripper {:.0f} mm", tool.gripper_m * 1e3);
    }
    if (tool.buttons != 0)
    {
        text += fmt::format(" buttons {:x}", tool.buttons);
    }
    return text + state;
}

std::string model_text(const ModelIdentity& identity, const ModelTelemetry& model)
{
    std::string text = fmt::format("; {} ", identity.name);
    if (model.stage != ModelStage::resident)
    {
        return text + kModelStageNames[static_cast<std::size_t>(model.stage)] +
               (model.server_gone ? " server gone" : "");
    }
    text += model.pages.capacity > 0
                ? fmt::format("{}/{} pages", model.pages.used, model.pages.capacity)
                : counted(model.pages.used, "page");
    if (model.piece_wait_ns > 0)
    {
        text += fmt::format(" {:.1f} ms", static_cast<double>(model.piece_wait_ns) * 1e-6);
    }
    if (model.follows_poses)
    {
        text += fmt::format(" pose {:.1f} ms old", static_cast<double>(model.pose_age_ns) * 1e-6);
    }
    return text + (model.server_gone ? " server gone" : "");
}

/// Number of models in each stage, as text; empty if all are resident.
std::string stages_text(const Telemetry& telemetry)
{
    std::array<std::uint32_t, kModelStages> counts{};
    for (std::size_t i = 0; i < telemetry.model_count; ++i)
    {
        ++counts[static_cast<std::size_t>(telemetry.models[i].stage)];
    }
    if (counts[static_cast<std::size_t>(ModelStage::resident)] == telemetry.model_count)
    {
        return "";
    }
    std::string text = fmt::format("; of {} models", telemetry.model_count);
    for (std::size_t i = 0; i < kModelStages; ++i)
    {
        text += counts[i] > 0 ? fmt::format(" {} {}", counts[i], kModelStageNames[i]) : "";
    }
    return text;
}

} // namespace

std::string watch_line(const dds::WatchedController& controller)
{
    const Telemetry& telemetry = controller.telemetry;
    const double frames = static_cast<double>(std::max<std::uint64_t>(telemetry.frame, 1));
    const auto sure =
        static_cast<double>(telemetry.exact + telemetry.separated + telemetry.within_tolerance);
    std::string text =
        fmt::format("watch {}: {} frames, {:.1f} % sure, {} stale, {} missed, {}", controller.name,
                    telemetry.frame, 100.0 * sure / frames, telemetry.stale, telemetry.missed,
                    counted(telemetry.overruns, "overrun"));
    for (std::size_t i = 0; i < telemetry.tool_count; ++i)
    {
        text += tool_text(telemetry.tools[i]);
    }
    text += stages_text(telemetry);
    for (std::size_t i = 0; i < telemetry.model_count; ++i)
    {
        text += model_text(controller.models[i], telemetry.models[i]);
    }
    return text;
}

void Watch::update(const dds::TelemetryReader& controllers, const dds::DdsServer& server,
                   ServingReport& report)
{
    const auto now = Clock::now();
    const std::chrono::duration<double> passed = now - last_;
    if (passed < kWatchPeriod)
    {
        return;
    }
    last_ = now;
    for (const dds::WatchedController& controller : controllers.controllers())
    {
        report.print_line(watch_line(controller));
    }
    print_served(server, passed.count(), report);
    print_refused(server, report);
}

/// Prints a line for each name of a controller, with the sums over all controllers of that name.
void Watch::print_served(const dds::DdsServer& server, double seconds, ServingReport& report)
{
    std::map<std::string, dds::DdsServer::Subscriber> all;
    for (const dds::DdsServer::Subscriber& one : server.subscribers())
    {
        dds::DdsServer::Subscriber& named = all[one.controller];
        named.pieces_sent += one.pieces_sent;
        named.bytes_sent += one.bytes_sent;
    }
    for (const auto& [name, now] : all)
    {
        const dds::DdsServer::Subscriber& before = served_[name];
        const auto since = [&](std::uint64_t total, std::uint64_t then)
        { return static_cast<double>(total - std::min(then, total)) / seconds; };
        report.print_line(fmt::format("served {}: {:.0f} pieces/s, {:.1f} KB/s, {} in all", name,
                                      since(now.pieces_sent, before.pieces_sent),
                                      since(now.bytes_sent, before.bytes_sent) * 1e-3,
                                      counted(now.pieces_sent, "piece")));
    }
    served_ = std::move(all);
}

/// Prints lines for the first 8 participants with new refusals and the number of further ones.
void Watch::print_refused(const dds::DdsServer& server, ServingReport& report)
{
    constexpr std::size_t kMostLines = 8;
    std::size_t lines = 0;
    for (const dds::PeerRefusals& peer : server.domain().participants().refusals().list())
    {
        std::uint64_t total = 0;
        std::string reasons;
        for (std::size_t i = 0; i < dds::kRefusedKinds; ++i)
        {
            total += peer.counts[i];
            reasons += peer.counts[i] > 0
                           ? fmt::format(", {} {}", dds::refused_names()[i], peer.counts[i])
                           : "";
        }
        std::uint64_t& before = refused_[peer.id];
        if (total > before && ++lines <= kMostLines)
        {
            report.print_line(fmt::format("refusals from {}: {} more{}",
                                          peer.name.empty() ? "an unknown participant" : peer.name,
                                          total - before, reasons));
        }
        before = total;
    }
    if (lines > kMostLines)
    {
        report.print_line("refusals from " + counted(lines - kMostLines, "more participant"));
    }
}

} // namespace tactus
