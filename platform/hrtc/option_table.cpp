// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/option_table.hpp"

#include "host_tools/cli/command_line.hpp"
#include "platform/hrtc/material_choice.hpp"
#include "platform/simulated/simulated_device.hpp"
#include "rt_core/limits.hpp"

#include <CLI/CLI.hpp>

namespace tactus::hrtc
{

namespace
{

constexpr double kLargestPool_mib = 4'096.0;
constexpr double kFrameBudgetMin_us = 10.0;
constexpr double kFrameBudgetMax_us = 10'000.0;

/// An option that takes one value and may be given several times.
void repeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values,
                const std::string& description)
{
    app.add_option(name, values, description)->expected(1)->allow_extra_args(false)->take_all();
}

/// The models, the tools that touch them and their devices.
void declare_scene(CLI::App& app, Options& options, RawOptions& raw)
{
    repeatable(app, "--model", options.models,
               "Model to touch: NAME or NAME@HASH as published, or with --transport file a "
               "path; repeatable");
    repeatable(app, "--place", raw.places,
               "Where the model stands, one for each --model in order: X,Y,Z in m "
               "[,RX,RY,RZ rotation vector in degrees [,SCALE]]");
    repeatable(app, "--material", raw.materials,
               "How the model feels, one for each --model in order: STIFFNESS in N/m, 1 to "
               "3000, the softer of this and --stiffness counts [,STATIC friction, 0 to 3 "
               "[,DYNAMIC friction, at most the static one [,DAMPING in N s/m, 0 to 20]]]");
    repeatable(app, "--tool", raw.tools,
               "Tool: sphere:RADIUS_M, 1e-5 to 1 m; repeatable [one sphere of 1 % of the first "
               "model's diagonal]");
    repeatable(app, "--device", raw.devices,
               "What moves the tool, one for each --tool in order: sim[:CLASS], a simulated "
               "hand on a device of the class touch, omega or delta; udp[:[ADDRESS:]PORT], a "
               "driver of your own; dhd[:INDEX], a device of Force "
               "Dimension's; replay:FILE, the hand of a recording; repeatable [sim]");
    repeatable(app, "--device-frame", raw.device_frames,
               "Where the device's coordinates are in the world, one for each --device in "
               "order: as --place, SCALE being that of its motion");
    repeatable(app, "--device-fault", raw.device_faults,
               "For tests: what goes wrong with the readings of simulated devices: "
               "KIND@FRAME+LENGTH with jitter, dropout, stuck, nan, time_jump or disconnect, "
               "from that frame on for so many; repeatable");
    app.add_option("--motion", raw.motion,
                   "What simulated hands do: script, free, approach, slide, tap, teleport, spin or "
                   "tremor [script]");
}

void declare_run(CLI::App& app, Options& options)
{
    app.add_option("--rate", options.rate_hz, "Frames a second")
        ->check(CLI::Range(SimulatedDeviceOptions::kRateMinHz, SimulatedDeviceOptions::kRateMaxHz))
        ->capture_default_str();
    app.add_option("--duration", options.duration_s, "Seconds to run")
        ->check(number_between(0.1, 86'400.0))
        ->capture_default_str();
    app.add_option("--report", options.report_path,
                   "Write the report to this file: a page when its name ends in .html, else JSON");
}

/// Memory, and the work of a frame.
void declare_budgets(CLI::App& app, Options& options, RawOptions& raw)
{
    app.add_option("--pool-mib", options.pool_mib,
                   "Memory for all pools of all models, in MiB, everything counted")
        ->check(number_between(0.25, kLargestPool_mib))
        ->capture_default_str();
    app.add_option("--cache-mib", options.cache_mib,
                   "Share of it for pages of records, in MiB [about six tenths]")
        ->check(number_between(0.05, kLargestPool_mib));
    app.add_option("--splits", options.splits, "Splits and merges in one frame at most")
        ->check(CLI::Range(std::uint32_t{1}, kMaxSplitsPerFrame))
        ->capture_default_str();
    app.add_option("--frame-budget-us", options.frame_budget_us,
                   "Microseconds that a frame may take: its budgets follow what frames cost, "
                   "--splits being the most [budgets fixed]")
        ->check(number_between(kFrameBudgetMin_us, kFrameBudgetMax_us));
    app.add_flag_callback(
        "--no-static", [&options] { options.static_when_it_fits = false; },
        "Refine locally also a model that fits the pools as a whole");
    app.add_option("--predict", raw.prediction,
                   "How the regions to load are foretold: local, linear, quadratic, distance, or "
                   "auto, whichever erred least of late")
        ->check(CLI::IsMember(kPredictionNames))
        ->capture_default_str();
}

void declare_force(CLI::App& app, Options& options)
{
    app.add_option("--stiffness", options.stiffness_n_per_m, "Of the virtual wall, in N/m")
        ->check(number_between(1.0, kStiffest_n_per_m))
        ->capture_default_str();
    app.add_option("--speed-limit", options.speed_limit_m_per_s,
                   "Speed of the hand, in m/s, above which its force fades [the device's own]")
        ->check(number_between(0.01, 100.0));
    app.add_option("--follow-speed", options.follow_speed_m_per_s,
                   "In m/s, at which a tool in contact follows a faster hand; what it needs round "
                   "itself grows with it [a diagonal of the first model a second]")
        ->check(number_between(0.001, 100.0));
}

void declare_transport(CLI::App& app, Options& options, RawOptions& raw)
{
    app.add_option("--transport", raw.transport, "Where models come from")
        ->check(CLI::IsMember({"dds", "file"}))
        ->capture_default_str();
    app.add_option("--domain", options.domain, "DDS domain id")
        ->check(CLI::Range(0, 232))
        ->capture_default_str();
    app.add_flag("--ignore-poses", raw.ignores_poses,
                 "Leave the models where --place puts them, whatever their hosts say");
    app.add_option("--wait", options.wait_s,
                   "Seconds to wait for a model to be published, and for a device to come")
        ->check(number_between(0.1, 3'600.0))
        ->capture_default_str();
}

void declare_thread(CLI::App& app, Options& options, RawOptions& raw)
{
    app.add_option("--priority", options.thread.priority,
                   "SCHED_FIFO priority of the haptic thread")
        ->check(CLI::Range(RtThreadOptions::kPriorityMin, RtThreadOptions::kPriorityMax))
        ->capture_default_str();
    app.add_option("--cpu", raw.cpu, "Processor of the haptic thread [left to the system]")
        ->check(CLI::Range(0, 1'023));
    app.add_flag("--allow-no-rt", options.thread.allow_no_rt,
                 "Run without SCHED_FIFO or locked memory when they are refused");
    app.add_flag("--trap-system-calls", options.trap_system_calls,
                 "For tests: count the system calls that frames make, which must be none; every "
                 "call of the haptic thread costs some 3 us more");
}

/// The file's keys are the options' names without the dashes.
void declare_config(CLI::App& app, RawOptions& raw)
{
    app.set_config("--config", "", "Read options from this TOML file; the command line goes first");
    app.get_config_ptr()->configurable(false);
    app.allow_config_extras(CLI::config_extras_mode::error);
    app.add_flag("--print-config", raw.prints_config,
                 "Print what the options come to as such a file, and end")
        ->configurable(false);
}

void declare_recording(CLI::App& app, Options& options)
{
    app.add_option("--record", options.record_path,
                   "Record all that goes into every frame, and hashes of what comes out, into this "
                   "file");
    app.add_option("--replay", options.replay_path,
                   "Instead of a run: give the frames of a recording the same again; exit code 1 "
                   "when one comes out otherwise. Takes no other option");
}

} // namespace

void declare_options(CLI::App& app, Options& options, RawOptions& raw, const CommandForm& form)
{
    app.set_version_flag("--version", std::string("hrtc ") + TACTUS_VERSION);
    declare_scene(app, options, raw);
    declare_run(app, options);
    declare_budgets(app, options, raw);
    declare_force(app, options);
    declare_transport(app, options, raw);
    declare_thread(app, options, raw);
    declare_config(app, raw);
    if (form.records)
    {
        declare_recording(app, options);
    }
    if (form.declare)
    {
        form.declare(app);
    }
    app.footer(form.footer);
}

} // namespace tactus::hrtc
