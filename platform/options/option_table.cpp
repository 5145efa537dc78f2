// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/option_table.hpp"

#include "platform/choices/option_ranges.hpp"
#include "rt_core/limits.hpp"

#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Declares the options of the objects.
void declare_scene(CommandLine& line, Options& options, RawOptions& raw)
{
    line.begin_task("Models and objects", "hrtc ball.spm --place 0,0,0.1 --material 800,0.6,0.4");
    line.add_option("FILE", raw.files,
                    "Model files (.spm) or a scene file (.gltf, .glb) to touch without a server; "
                    "the same as --model FILE or --scene FILE")
        .not_in_file();
    line.add_option("--model", raw.models,
                    "Model to touch: NAME, NAME@HASH or NAME@SERVER as published, or a file. "
                    "Repeatable, one for each object; several objects may show the same model")
        .repeatable();
    line.add_option("--scene", options.scene,
                    "Scene to touch instead of --model: NAME or NAME@SERVER of a server's scene, "
                    "or a glTF file as spm_build writes it, with the model files beside it. A "
                    "server may add, move and remove objects during the run");
    line.add_option("--place", raw.places,
                    "Pose of an object: X,Y,Z in m [,RX,RY,RZ rotation vector in degrees "
                    "[,SCALE]]. Repeatable, one for each --model in order; each further one adds "
                    "an object that shows the last model")
        .repeatable();
    line.add_option(
            "--objects", options.objects_max,
            "Maximum number of objects, at least the number at the start [default: the number at "
            "the start; for a server's scene, one for each 4 KiB of --pool-mib, at least 64]")
        .integer_between(1U, kMaxObjects);
    line.add_option("--material", raw.materials,
                    "Material of an object. Repeatable, one for each object in order; objects "
                    "beyond the last --model have the material of the last --model. With --scene, "
                    "MATERIAL is for all objects, and OBJECT:MATERIAL for the object with this "
                    "name. MATERIAL is STIFFNESS in N/m, 1 to 3000 [,STATIC friction, 0 to 3 "
                    "[,DYNAMIC friction, at most the static one [,DAMPING in N s/m, 0 to 20]]], or "
                    "KEY=VALUE with commas between. The lower of STIFFNESS and --stiffness "
                    "applies. The keys are stiffness, static, dynamic, damping, viscosity (drag "
                    "along the surface in N s/m, 0 to 20), texture_height and texture_length "
                    "(bumps at the middle of a tool, in m, the height at most 1/32 of the length)")
        .repeatable();
}

/// Declares the options of tools and their devices.
void declare_tools(CommandLine& line, RawOptions& raw)
{
    line.begin_task("Tools, devices and simulated operators",
                    "hrtc ball.spm --tool sphere:0.002 --device udp:48500");
    line.add_option("--tools", raw.tool_count,
                    "Number of tools. The n-th --tool, --tool-mass, --fixture, --device, "
                    "--device-limits, --device-frame, --motion and --edit are for the n-th tool; "
                    "the value none selects the default. In an option file, the n-th table "
                    "[[tool]] has the keys shape, mass, fixture, edit, device, device-limits, "
                    "device-frame and motion "
                    "[default: the number of tools with any of these, at least 1]")
        .integer_between(1U, kMaxTools);
    for (std::size_t i = 0; i < kToolOptions; ++i)
    {
        const ToolOption& option = tool_options()[i];
        line.add_option(option.option, raw.of_tools[i], option.help).repeatable();
    }
    line.add_option("--device-key", raw.device_key,
                    "File with the key that authenticates the datagrams of udp devices and their "
                    "drivers: 64 hexadecimal digits, readable only by the file's owner or group "
                    "[default: no authentication, every sender is accepted]");
    line.add_option("--device-fault", raw.device_faults,
                    "Fault in the readings of simulated devices, for tests: KIND@FRAME+LENGTH, "
                    "where KIND is jitter, dropout, stuck, nan, time_jump or disconnect. The fault "
                    "begins at frame FRAME and lasts LENGTH frames. Repeatable")
        .repeatable();
}

void declare_run(CommandLine& line, Options& options, const CommandForm& form)
{
    line.begin_task("The run", "hrtc ball.spm --duration 5 --report run.html --report run.json");
    line.add_option("--rate", options.rate_hz, "Rate of the haptic loop, in frames a second")
        .integer_between(kRateRange_hz.low, kRateRange_hz.high)
        .show_default();
    line.add_option("--duration", options.duration_s, "Duration of the run, in seconds")
        .number_between(kDurationRange_s.low, kDurationRange_s.high)
        .show_default();
    line.add_flag("--strict", options.strict,
                  "Exit with code 1 if the verdict reports a loss: a lost server or device, a "
                  "damaged or late piece, a limited material, bounded answers only, a data-limited "
                  "tool, a wall too soft to feel, or no contact");
    line.add_option("--report", options.report_paths,
                    "File for the report: JSON if the name ends in .json, an HTML page if the name "
                    "ends in .html. Repeatable")
        .repeatable();
    if (!form.records)
    {
        return;
    }
    line.add_option("--histograms", options.histograms_folder,
                    "Folder for the percentiles of each time in the report, one file for each "
                    "time, such as frame.hgrm, in the text format of HdrHistogram");
    line.add_option("--trace", options.trace_path,
                    "File for a trace of frames, their stages, the queues and the chunk loader, in "
                    "Chrome's trace format (.json), which Perfetto opens; about 0.7 MB a second");
}

/// Declares the options of memory and of a frame's work.
void declare_budgets(CommandLine& line, Options& options, RawOptions& raw)
{
    line.begin_task("Memory and work", "hrtc large.spm --pool-mib 16 --frame-budget-us 500");
    line.add_option(
            "--pool-mib", options.pool_mib,
            "Maximum memory for the pools, tables and queues of all models together, in MiB")
        .number_between(kPoolRange_mib.low, kPoolRange_mib.high)
        .show_default();
    line.add_option(
            "--cache-mib", options.cache_mib,
            "Part of --pool-mib for pages of records, in MiB [default: about half of --pool-mib]")
        .number_between(kCacheRange_mib.low, kCacheRange_mib.high);
    line.add_option("--edit-faces", options.edit_faces,
                    "Room for faces that edits add, for each model that its server edits; part of "
                    "--pool-mib, about 150 bytes each. 0: the model takes no edits [default: the "
                    "server's room]")
        .integer_between(kEditFacesRange.low, kEditFacesRange.high);
    line.add_option("--splits", options.splits,
                    "Maximum number of splits, and of merges, in a frame. With --frame-budget-us "
                    "the default is the largest value")
        .integer_between(kSplitsRange.low, kSplitsRange.high)
        .show_default();
    line.add_option(
            "--frame-budget-us", options.frame_budget_us,
            "Time budget of a frame, in microseconds. The work of a frame adapts to the measured "
            "times of frames. The limit of the work is 1 instruction for each nanosecond, 2 with a "
            "hull tool, 8 with a mesh tool [default: half of the period]")
        .number_between(kFrameBudgetRange_us.low, kFrameBudgetRange_us.high);
    line.add_flag("--no-static", raw.refines_always,
                  "Refine a model locally even if the whole model fits the pools");
    line.add_option("--predict", raw.prediction,
                    "Method that predicts the regions to load: local, linear, quadratic, distance, "
                    "or auto, the method with the least recent error")
        .one_of({kPredictionNames.begin(), kPredictionNames.end()})
        .show_default();
    line.add_option("--kernels", raw.kernels,
                    "Processor instructions for queries: portable, or avx2 if the processor has "
                    "them. All give the same answers [default: the fastest available]");
}

void declare_force(CommandLine& line, Options& options)
{
    line.begin_task("Forces and speed limits", "hrtc ball.spm --stiffness 1000");
    line.add_option("--stiffness", options.stiffness_n_per_m,
                    "Stiffness of the virtual wall, in N/m")
        .number_between(kStiffnessRange_n_per_m.low, kStiffnessRange_n_per_m.high)
        .show_default();
    line.add_option("--angular-stiffness", options.angular_stiffness_nm_per_rad,
                    "Stiffness of the rotational spring of tools other than points and spheres, in "
                    "N m/rad. The device's own limit applies as well [default: --stiffness times "
                    "the square of the tool's size]")
        .number_between(kAngularStiffnessRange_nm_per_rad.low,
                        kAngularStiffnessRange_nm_per_rad.high);
    line.add_option(
            "--force-shading", options.shading_m,
            "Width of force shading, in metres. Points and spheres feel the facets within the "
            "width as one smooth surface, at most an eighth of the width away from the mesh. Edges "
            "of more than 25 degrees stay sharp [default: no shading, each facet is felt]")
        .number_between(kShadingRange_m.low, kShadingRange_m.high);
    line.add_option("--force-tolerance", options.force_tolerance_n,
                    "Largest change of a force by coarser levels that count as the surface, in "
                    "newtons; larger where the pools have no room for finer levels. With 0, only "
                    "exact faces count")
        .number_between(kForceToleranceRange_n.low, kForceToleranceRange_n.high)
        .show_default();
    line.add_option("--slew", options.slew_share_per_ms,
                    "Maximum change of a force in a millisecond beyond the effect of hand and "
                    "objects, as a share of the device's largest force")
        .number_between(kSlewRange_per_ms.low, kSlewRange_per_ms.high)
        .show_default();
    line.add_option("--clutch", options.clutch_button,
                    "Clutch button of each device, counted from 0. While the button is held, the "
                    "hand moves freely and the tool stays in place without a force [default: none]")
        .integer_between(kClutchRange.low, kClutchRange.high);
    line.add_option("--speed-limit", options.speed_limit_m_per_s,
                    "Speed of the hand above which its force fades, in m/s [default: the device's "
                    "own limit]")
        .number_between(kSpeedLimitRange_m_per_s.low, kSpeedLimitRange_m_per_s.high);
    line.add_option("--object-speed", options.object_speed_m_per_s,
                    "Object speed limit, in m/s, for objects that a tool touches or may touch "
                    "within 20 ms. If a server moves an object faster, the object follows at the "
                    "limit, and the force fades while the object is far behind")
        .number_between(kObjectSpeedRange_m_per_s.low, kObjectSpeedRange_m_per_s.high)
        .show_default();
    line.add_option("--proxy-speed", options.proxy_speed_m_per_s,
                    "Proxy speed limit, in m/s: the speed at which a tool in contact follows a "
                    "faster hand. The reach of the tool grows with the limit [default: a diagonal "
                    "of the first model a second]")
        .number_between(kProxySpeedRange_m_per_s.low, kProxySpeedRange_m_per_s.high);
}

void declare_transport(CommandLine& line, Options& options, RawOptions& raw)
{
    line.begin_task("Servers and files", "hrtc --model ball --domain 7 --wait 60");
    line.add_option("--transport", raw.transport,
                    "Source of the models: dds (servers) or file [default: file if a file is "
                    "named, otherwise dds]")
        .one_of({"dds", "file"});
    line.add_option("--domain", options.domain,
                    "DDS domain. With models from files, the option makes the run visible to "
                    "viewers (spm_view) in that domain")
        .integer_between(kDomainRange.low, kDomainRange.high)
        .show_default();
    line.add_security_options(options.security);
    line.add_option("--name", options.name,
                    "Name of the controller with DDS (1 to 63 bytes of letters, digits, . _ -). "
                    "Servers show the name, and access rights can refer to it [default: hrtc-PID; "
                    "with --security, the name of the certificate]");
    line.add_option(
            "--failover", raw.failover,
            "Server that may replace the first server if that one is lost: MACHINE or "
            "MACHINE:PROCESS, or with DDS Security the certificate, its name or cert:HEX, as in "
            "NAME@SERVER, log lines and reports. The value any allows every server of the same "
            "models. Repeatable [default: none; with DDS Security, a server with the same "
            "certificate]")
        .repeatable();
    line.add_flag("--ignore-poses", raw.ignores_poses,
                  "Keep the objects at their start poses from --place or --scene; ignore the poses "
                  "that servers send");
    line.add_flag("--no-refinement-state", raw.hides_refinement_state,
                  "With DDS, do not send the refinement state to viewers (spm_view)");
    line.add_option(
            "--wait", options.wait_s,
            "Maximum wait for a model to be published and for a device to connect, in seconds")
        .number_between(kWaitRange_s.low, kWaitRange_s.high)
        .show_default();
}

void declare_thread(CommandLine& line, Options& options, RawOptions& raw)
{
    line.begin_task("Real-time thread", "hrtc ball.spm --cpu 1 --priority 90");
    line.add_option("--priority", options.thread.priority,
                    "SCHED_FIFO priority of the haptic thread")
        .integer_between(RtThreadOptions::kPriorityMin, RtThreadOptions::kPriorityMax)
        .show_default();
    line.add_option("--supervisor-periods", options.supervisor_periods,
                    "Number of periods without a heartbeat of the haptic loop until the supervisor "
                    "brakes the devices [default: 3 on a PREEMPT_RT kernel, 10 elsewhere]")
        .integer_between(kSupervisorRange.low, kSupervisorRange.high);
    line.add_option("--cpu", raw.cpu,
                    "Processor of the haptic thread [default: left to the system]")
        .integer_between(kCpuRange.low, kCpuRange.high);
    line.add_flag("--allow-no-rt", options.thread.allow_no_rt,
                  "Run without SCHED_FIFO or locked memory if the system refuses them");
    line.add_flag("--trap-system-calls", options.trap_system_calls,
                  "Count the system calls in frames, for tests; there must be none. Each system "
                  "call of the haptic thread takes about 3 us longer");
}

/// Declares the option file, whose keys are the options' names without the dashes.
void declare_config(CommandLine& line, RawOptions& raw)
{
    line.begin_task("Options from a file",
                    "hrtc ball.spm --print-config >my.toml; hrtc --config my.toml");
    line.add_option_file("--config", "TOML file with options; the command line overrides the file");
    std::vector<std::string> keys;
    for (const ToolOption& option : tool_options())
    {
        keys.emplace_back(option.key);
    }
    line.add_option_tables("tool", keys, raw.tool_tables);
    line.add_flag("--print-config", raw.prints_config,
                  "Print the resulting options as a TOML file, and exit")
        .not_in_file();
}

void declare_recording(CommandLine& line, Options& options)
{
    line.begin_task("Virtual time, recording and replay",
                    "hrtc ball.spm --record run.rec; hrtc --replay run.rec");
    line.add_flag("--virtual-time", options.virtual_time,
                  "Use a clock that stands still during computation. The run is as fast as the "
                  "machine allows, gives the same result each time, and measures no deadlines. "
                  "Needs models from files, and simulated or recorded devices");
    line.add_option(
        "--record", options.record_path,
        "File for a recording of all inputs of every frame, with hashes of the outputs");
    line.add_option("--replay", options.replay_path,
                    "Recording to replay instead of a run. Exit code 1 if a frame has another "
                    "result than before. Takes --kernels, --export and no other option");
    line.add_option("--export", options.export_paths,
                    "File for the frames of --replay with all inputs and outputs: a table if the "
                    "name ends in .csv, JSON lines if in .jsonl, a file for PlotJuggler and "
                    "Foxglove if in .mcap. Repeatable")
        .repeatable();
}

/// Options of version 0.2.0 that are called otherwise.
constexpr std::array<std::pair<const char*, const char*>, 4> kFormerNames{
    {{"follow-speed", "proxy-speed"},
     {"guide", "fixture"},
     {"no-front", "no-refinement-state"},
     {"smooth", "force-shading"}}};

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
    for (const auto& [former, name] : kFormerNames)
    {
        line.add_former_name(former, name);
    }
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
