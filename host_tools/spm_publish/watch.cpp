// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

constexpr auto kWatchPeriod = std::chrono::seconds(1);

std::string tool_text(const ToolTelemetry& tool)
{
    const auto& n = tool.force_n;
    const char* state = tool.frozen       ? " frozen"
                        : tool.squeezed   ? " squeezed"
                        : tool.in_contact ? " in contact"
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
    std::string text =
        fmt::format("; {} {}/{} pages", identity.name, model.pages.used, model.pages.capacity);
    if (model.piece_wait_ns > 0)
    {
        text += fmt::format(" {:.1f} ms", static_cast<double>(model.piece_wait_ns) * 1e-6);
    }
    if (model.follows_poses)
    {
        text += fmt::format(" pose {:.1f} ms old", static_cast<double>(model.pose_age_ns) * 1e-6);
    }
    return text + (model.host_gone ? " host gone" : "");
}

} // namespace

std::string watch_line(const dds::WatchedController& controller)
{
    const Telemetry& telemetry = controller.telemetry;
    const double frames = static_cast<double>(std::max<std::uint64_t>(telemetry.frame, 1));
    const auto sure = static_cast<double>(telemetry.exact + telemetry.decided);
    std::string text =
        fmt::format("watch {}: {} frames, {:.1f} % sure, {} stale, {} missed, {} own faults",
                    controller.name, telemetry.frame, 100.0 * sure / frames, telemetry.stale,
                    telemetry.missed, telemetry.own_faults);
    for (std::size_t i = 0; i < telemetry.tool_count; ++i)
    {
        text += tool_text(telemetry.tools[i]);
    }
    for (std::size_t i = 0; i < telemetry.model_count; ++i)
    {
        text += model_text(controller.models[i], telemetry.models[i]);
    }
    return text;
}

void Watch::update(ServingReport& report)
{
    reader_->poll();
    const auto now = Clock::now();
    if (now - last_ < kWatchPeriod)
    {
        return;
    }
    last_ = now;
    for (const dds::WatchedController& controller : reader_->controllers())
    {
        report.print_line(watch_line(controller));
    }
}

} // namespace tactus
