// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/option_table.hpp"

#include "platform/devices/simulated/simulated_device.hpp"
#include "platform/options/tool_options.hpp"
#include "platform/program/command_line.hpp"
#include "rt_core/limits.hpp"
#include "transport/material_ranges.hpp"

namespace tactus::hrtc
{

namespace
{

constexpr double kLargestPool_mib = 4'096.0;
constexpr double kFrameBudgetMin_us = 1e-3 * WorkBudget::kLeast;
constexpr double kFrameBudgetMax_us = 10'000.0;

/// Declares the options of the objects.
void declare_scene(CommandLine& line, Options& options, RawOptions& raw)
{
    line.begin_task("What is touched", "hrtc ball.spm --place 0,0,0.1 --material 800,0.6,0.4");
    line.add_option("FILE", raw.files,
                    "Models to touch without a host (.spm), or a scene (.gltf, .glb): as --model "
                    "FILE and --scene FILE")
        .not_in_file();
    line.add_option("--model", raw.models,
                    "Model to touch: NAME, NAME@HASH or NAME@SERVER as published, or a file; "
                    "repeatable, the same one for several objects that show it")
        .repeatable();
    line.add_option("--scene", options.scene,
                    "Instead of --model: all objects of the host whose scene has this name, NAME "
                    "or NAME@SERVER, as they come, move and go; or those of a glTF file, each with "
                    "its model beside the file, as spm_build writes it");
    line.add_option("--place", raw.places,
                    "Where the object stands, one for each --model in order, and more for further "
                    "objects that show the last one: X,Y,Z in m "
                    "[,RX,RY,RZ rotation vector in degrees [,SCALE]]")
        .repeatable();
    line.add_option("--objects", options.objects_max,
                    "Room for so many objects, at least those that are placed; 1 to 4096 "
                    "[as many as are placed; of a host's scene as many as --pool-mib has of 4 KiB, "
                    "64 at least]")
        .integer_between(1U, kMaxObjects);
    line.add_option(
            "--material", raw.materials,
            "How the object feels, one for each in order, and further ones as the last --model; "
            "of a scene all objects, or with OBJECT: before it the one of this name: STIFFNESS in "
            "N/m, 1 to "
            "3000, the softer of this and --stiffness counts [,STATIC friction, 0 to 3 "
            "[,DYNAMIC friction, at most the static one [,DAMPING in N s/m, 0 to 20]]]; or any "
            "of stiffness=, static=, dynamic=, damping=, viscosity= (drag along the surface in N "
            "s/m, 0 to 20), texture_height= and texture_length= (bumps, in m, at most 1/32 as high "
            "as long, felt where the middle of a tool is), with commas between")
        .repeatable();
}

/// Declares the options of tools and their devices.
void declare_tools(CommandLine& line, RawOptions& raw)
{
    line.begin_task("Hands, tools and devices",
                    "hrtc ball.spm --tool sphere:0.002 --device udp:48500");
    line.add_option("--tools", raw.tool_count,
                    "Number of tools, 1 to 16. The n-th --tool, --tool-mass, --fixture, --device, "
                    "--device-limits, --device-frame and --motion are for tool n, or none for its "
                    "default; in an option file the n-th table [[tool]] has shape, mass, fixture, "
                    "device, device-limits, device-frame and motion [as many as these speak of, "
                    "or 1]")
        .integer_between(1U, kMaxTools);
    for (std::size_t i = 0; i < kToolOptions; ++i)
    {
        const ToolOption& option = tool_options()[i];
        line.add_option(option.option, raw.of_tools[i], option.help).repeatable();
    }
    line.add_option(
        "--device-key", raw.device_key,
        "File with the key that udp devices and their drivers authenticate their datagrams "
        "with: 64 hexadecimal digits, readable by its owner or group alone [no authentication: "
        "every sender is accepted]");
    line.add_option("--device-fault", raw.device_faults,
                    "For tests: what goes wrong with the readings of simulated devices: "
                    "KIND@FRAME+LENGTH with jitter, dropout, stuck, nan, time_jump or disconnect, "
                    "from that frame on for so many; repeatable")
        .repeatable();
}

void declare_run(CommandLine& line, Options& options, const CommandForm& form)
{
    line.begin_task("The run", "hrtc ball.spm --duration 5 --report run.html --report run.json");
    line.add_option("--rate", options.rate_hz, "Frames a second")
        .integer_between(SimulatedDeviceOptions::kRateMinHz, SimulatedDeviceOptions::kRateMaxHz)
        .show_default();
    line.add_option("--duration", options.duration_s, "Seconds to run")
        .number_between(0.1, 86'400.0)
        .show_default();
    line.add_flag("--strict", options.strict,
                  "Exit with 1 when a host or a device was lost, a piece came damaged or didn't "
                  "come within a second, a wall was too soft to feel, or nothing was touched");
    line.add_option("--report", options.report_paths,
                    "Write the report to this file: JSON when its name ends in .json, a page when "
                    "it ends in .html; repeatable")
        .repeatable();
    if (!form.records)
    {
        return;
    }
    line.add_option("--histograms", options.histograms_folder,
                    "Write the percentiles of each time of the report into this folder, as "
                    "HdrHistogram prints them: frame.hgrm and so on");
    line.add_option(
        "--trace", options.trace_path,
        "Write when each frame, its stages, the queues and the chunk loader did what, in "
        "Chrome's trace format (.json), which Perfetto opens; some 0.7 MB a second");
}

/// Declares the options of memory and of a frame's work.
void declare_budgets(CommandLine& line, Options& options, RawOptions& raw)
{
    line.begin_task("Memory and work", "hrtc large.spm --pool-mib 16 --frame-budget-us 500");
    line.add_option("--pool-mib", options.pool_mib,
                    "Memory for all pools of all models, in MiB, at most, everything counted")
        .number_between(0.25, kLargestPool_mib)
        .show_default();
    line.add_option("--cache-mib", options.cache_mib,
                    "Share of it for pages of records, in MiB [about six tenths]")
        .number_between(0.05, kLargestPool_mib);
    line.add_option("--splits", options.splits, "Splits and merges in one frame at most")
        .integer_between(std::uint32_t{1}, kMaxSplitsPerFrame)
        .show_default();
    line.add_option(
            "--frame-budget-us", options.frame_budget_us,
            "Microseconds that a frame may take: its work is at most an instruction for each "
            "nanosecond, two with a hull, eight with a mesh, and follows what frames take [half of "
            "the period]")
        .number_between(kFrameBudgetMin_us, kFrameBudgetMax_us);
    line.add_flag("--no-static", raw.refines_always,
                  "Refine locally also a model that fits the pools as a whole");
    line.add_option("--predict", raw.prediction,
                    "How the regions to load are predicted: local, linear, quadratic, distance, or "
                    "auto, whichever erred least of late")
        .one_of({kPredictionNames.begin(), kPredictionNames.end()})
        .show_default();
    line.add_option("--kernels", raw.kernels,
                    "Instructions of the processor that queries are made of: portable, or avx2 "
                    "where there is that; no answer differs [the fastest that there are]");
}

void declare_force(CommandLine& line, Options& options)
{
    line.begin_task("How it feels", "hrtc ball.spm --stiffness 1000");
    line.add_option("--stiffness", options.stiffness_n_per_m, "Of the virtual wall, in N/m")
        .number_between(1.0, kStiffest_n_per_m)
        .show_default();
    line.add_option("--angular-stiffness", options.angular_stiffness_nm_per_rad,
                    "Of the spring that turns tools other than spheres, in N m/rad; the device's "
                    "own cap holds for it, too [--stiffness times the square of the tool's size]")
        .number_between(kSoftestTurn_nm_per_rad, kStiffestTurn_nm_per_rad);
    line.add_option("--force-shading", options.shading_m,
                    "Points and spheres feel facets within this width, in metres, as one smooth "
                    "surface, which is within an eighth of it of the mesh; edges of more than "
                    "25 degrees stay [each facet is felt]")
        .number_between(kShadingWidthMin_m, kShadingWidthMax_m);
    line.add_option("--force-tolerance", options.force_tolerance_n,
                    "Coarser levels count as the surface where that changes a force by no more "
                    "than this, in newtons, and farther where the pools have no room for finer "
                    "ones; 0: only exact faces do. Not for mesh tools")
        .number_between(0.0, kForceToleranceMax_n)
        .show_default();
    line.add_option("--slew", options.slew_share_per_ms,
                    "How fast a force may change beside what hand and objects make, as a share of "
                    "the device's largest force in a millisecond")
        .number_between(kSlewShareMin_per_ms, 1.0)
        .show_default();
    line.add_option("--clutch", options.clutch_button,
                    "Button of each device, from 0, that parts hand and tool while it is held: the "
                    "tool stays, without a force, and goes on from there [none]")
        .integer_between(0U, kButtons - 1U);
    line.add_option("--speed-limit", options.speed_limit_m_per_s,
                    "Speed of the hand, in m/s, above which its force fades [the device's own]")
        .number_between(0.01, 100.0);
    line.add_option("--object-speed", options.object_speed_m_per_s,
                    "Speed limit, in m/s, of an object that a tool touches or may within 20 ms: "
                    "it is carried no faster, and the force fades while its host moves it "
                    "farther")
        .number_between(0.001, 100.0)
        .show_default();
    line.add_option("--proxy-speed", options.proxy_speed_m_per_s,
                    "In m/s, at which a tool in contact follows a faster hand; what it needs round "
                    "itself grows with it [a diagonal of the first model a second]")
        .number_between(0.001, 100.0);
}

void declare_transport(CommandLine& line, Options& options, RawOptions& raw)
{
    line.begin_task("Where models come from", "hrtc --model ball --domain 7 --wait 60");
    line.add_option("--transport", raw.transport,
                    "Where models come from [files where they are named, else DDS]")
        .one_of({"dds", "file"});
    line.add_option("--domain", options.domain,
                    "DDS domain; given with models from files, viewers (spm_view) see the run "
                    "there")
        .integer_between(0, 232)
        .show_default();
    line.add_option("--name", options.name,
                    "With DDS: the controller's name, 1 to 63 bytes of letters, digits, . _ -, "
                    "that hosts show and by which rights can be given [hrtc-PID]");
    line.add_option("--failover", raw.failover,
                    "Which server may take the place of the one that was taken at the start, when "
                    "that is gone: SERVER, as in NAME@SERVER, is its machine, MACHINE or "
                    "MACHINE:PROCESS, or with DDS Security its certificate, cert:HEX, as lines and "
                    "reports name it; any: any that offers the same; repeatable [none; with DDS "
                    "Security one with the same certificate]")
        .repeatable();
    line.add_flag("--ignore-poses", raw.ignores_poses,
                  "Leave the objects where --place or --scene put them at the start, whatever "
                  "their hosts say");
    line.add_flag("--no-refinement-state", raw.hides_refinement_state,
                  "With DDS: do not tell viewers (spm_view) which parts of the models are refined");
    line.add_option("--wait", options.wait_s,
                    "Seconds to wait for a model to be published, and for a device to come")
        .number_between(0.1, 3'600.0)
        .show_default();
}

void declare_thread(CommandLine& line, Options& options, RawOptions& raw)
{
    line.begin_task("The machine", "hrtc ball.spm --cpu 1 --priority 90");
    line.add_option("--priority", options.thread.priority,
                    "SCHED_FIFO priority of the haptic thread")
        .integer_between(RtThreadOptions::kPriorityMin, RtThreadOptions::kPriorityMax)
        .show_default();
    line.add_option("--supervisor-periods", options.supervisor_periods,
                    "Periods that the haptic loop may be silent until the supervisor takes the "
                    "forces away [3 on a PREEMPT_RT kernel, 10 elsewhere]")
        .integer_between(2U, 1'000U);
    line.add_option("--cpu", raw.cpu, "Processor of the haptic thread [left to the system]")
        .integer_between(0, 1'023);
    line.add_flag("--allow-no-rt", options.thread.allow_no_rt,
                  "Run without SCHED_FIFO or locked memory when they are refused");
    line.add_flag("--trap-system-calls", options.trap_system_calls,
                  "For tests: count the system calls that frames make, which must be none; every "
                  "call of the haptic thread costs some 3 us more");
}

/// Declares the option file, whose keys are the options' names without the dashes.
void declare_config(CommandLine& line, RawOptions& raw)
{
    line.begin_task("Options from a file",
                    "hrtc ball.spm --print-config >my.toml; hrtc --config my.toml");
    line.add_option_file("--config",
                         "Read options from this TOML file; the command line goes first");
    std::vector<std::string> keys;
    for (const ToolOption& option : tool_options())
    {
        keys.emplace_back(option.key);
    }
    line.add_option_tables("tool", keys, raw.tool_tables);
    line.add_flag("--print-config", raw.prints_config,
                  "Print what the options come to as such a file, and end")
        .not_in_file();
}

void declare_recording(CommandLine& line, Options& options)
{
    line.begin_task("Runs that can be repeated",
                    "hrtc ball.spm --record run.rec; hrtc --replay run.rec");
    line.add_flag("--virtual-time", options.virtual_time,
                  "With models from files and simulated or recorded hands: a clock that stands "
                  "still while anything is computed, so that the run is as fast as the machine "
                  "goes, comes out the same each time, and says nothing of deadlines");
    line.add_option(
        "--record", options.record_path,
        "Record all that goes into every frame, and hashes of what comes out, into this "
        "file");
    line.add_option("--replay", options.replay_path,
                    "Instead of a run: give the frames of a recording the same again; exit code 1 "
                    "when one comes out otherwise. Takes --kernels, --export and no other option");
    line.add_option("--export", options.export_paths,
                    "With --replay: write its frames for other tools, with all that went in and "
                    "came out: a table when the name ends in .csv, JSON lines when in .jsonl, for "
                    "PlotJuggler and Foxglove when in .mcap; repeatable")
        .repeatable();
}

} // namespace

void declare_options(CommandLine& line, Options& options, RawOptions& raw, const CommandForm& form)
{
    line.add_version(std::string("hrtc ") + TACTUS_VERSION);
    declare_scene(line, options, raw);
    declare_tools(line, raw);
    declare_run(line, options, form);
    declare_budgets(line, options, raw);
    declare_force(line, options);
    declare_transport(line, options, raw);
    declare_thread(line, options, raw);
    declare_config(line, raw);
    if (form.records)
    {
        declare_recording(line, options);
    }
    line.add_log_options();
    if (form.declare)
    {
        form.declare(line);
    }
    line.set_footer(form.footer);
}

} // namespace tactus::hrtc
