// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/options.hpp"

#include "platform/export/frame_export.hpp"
#include "platform/options/option_table.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/progress.hpp"
#include "platform/program/run_program.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/program_log.hpp"
#include "transport/base/refusal.hpp"
#include "transport/material_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <span>
#include <sstream>
#include <string_view>

namespace tactus::hrtc
{

namespace
{

/// Kernels of this name among those that the processor supports (available_kernels()). The refusal
/// of another name lists the available ones.
Result<const Kernels*, Refusal> choose_kernels(std::string_view name,
                                               std::span<const Kernels* const> available)
{
    std::string names;
    for (const Kernels* kernels : available)
    {
        if (kernels->name == name)
        {
            return kernels;
        }
        names += (names.empty() ? "" : ", ") + std::string(kernels->name);
    }
    return Refusal{fmt::format("--kernels: '{}' is not one of the kernels for this processor: {}",
                               printable(name), names)};
}

/// Largest number of device faults; each reading of a device checks all.
constexpr std::size_t kDeviceFaultsMax = 64;

/// Text of an option file for these options. Options without a value become comments, because a
/// file can't unset an option. Files given without an option appear as --model or --scene, and
/// tools as tables.
std::string option_file(const CommandLine& line, const Options& options, const RawOptions& raw)
{
    std::istringstream lines(line.option_file_text());
    std::string text;
    for (std::string entry; std::getline(lines, entry);)
    {
        if (entry.starts_with("model=") && !raw.models.empty())
        {
            entry = fmt::format("model=[\"{}\"]", fmt::join(raw.models, "\", \""));
        }
        else if (entry.starts_with("scene=") && !options.scene.empty())
        {
            entry = fmt::format("scene=\"{}\"", options.scene);
        }
        for (const ToolOption& option : tool_options())
        {
            const std::string key = std::string(option.option).substr(2) + "=";
            entry = entry.starts_with(key) ? key + "\"\"" : entry;
        }
        text += (entry.ends_with("=\"\"") ? "# " : "") + entry + '\n';
    }
    return text + tool_tables(raw);
}

/// Fault of the options given beside --replay, which takes all other settings from the recording;
/// empty if none.
std::string check_replay(const CommandLine& line)
{
    for (const std::string& name : line.given())
    {
        if (name != "--replay" && name != "--kernels" && name != "--export" &&
            name != "--log-level" && name != "--json-log")
        {
            return "--replay: takes only --kernels, --export, --log-level and --json-log; " + name +
                   " was given";
        }
    }
    return {};
}

std::string check_exports(const Options& options)
{
    for (const std::string& path : options.export_paths)
    {
        if (options.replay_path.empty())
        {
            return "--export: needs --replay";
        }
        if (!is_export_name(path))
        {
            return fmt::format("--export: '{}' must end in .csv, .jsonl or .mcap", printable(path));
        }
        if (std::ranges::count(options.export_paths, path) > 1)
        {
            return fmt::format("--export: '{}' is given twice", printable(path));
        }
        if (path == options.replay_path)
        {
            return "--export: must be another file than --replay";
        }
    }
    return "";
}

std::string check_files(const CommandLine& line, const Options& options)
{
    for (const auto& [name, path] :
         {std::pair("--record", &options.record_path), std::pair("--replay", &options.replay_path),
          std::pair("--trace", &options.trace_path),
          std::pair("--histograms", &options.histograms_folder)})
    {
        if (line.is_given(name) && path->empty())
        {
            return std::string(name) + ": the name is empty";
        }
    }
    if (const std::string fault = check_exports(options); !fault.empty())
    {
        return fault;
    }
    for (const std::string& path : options.report_paths)
    {
        if (path.empty())
        {
            return "--report: the name is empty";
        }
        if (!path.ends_with(".json") && !is_page_name(path))
        {
            return fmt::format("--report: '{}' must end in .json or .html", printable(path));
        }
        if (std::ranges::count(options.report_paths, path) > 1)
        {
            return fmt::format("--report: '{}' is given twice", printable(path));
        }
        for (const auto& [name, other] : {std::pair("--record", &options.record_path),
                                          std::pair("--trace", &options.trace_path)})
        {
            if (path == *other)
            {
                return fmt::format("{}: must be another file than --report", name);
            }
        }
    }
    if (!options.trace_path.empty() && options.trace_path == options.record_path)
    {
        return "--trace: must be another file than --record";
    }
    return "";
}

/// Adds an object for each --model; further --place options add objects of the last model. If a
/// model is named twice, two objects share it. Returns the fault; empty if none.
std::string check_models(Options& options, const RawOptions& raw)
{
    if (!options.scene.empty())
    {
        if (!raw.models.empty() || !raw.places.empty())
        {
            return "--scene: can't be combined with --model and --place";
        }
        if (std::string fault = options.scene_materials.parse(raw.materials); !fault.empty())
        {
            return fault;
        }
        if (raw.transport == "file")
        {
            return "";
        }
        const auto selector = parse_selector(options.scene);
        return !selector ? "--scene: " + selector.error().text
               : selector.value().hash
                   ? "--scene: only models have a hash; a scene is NAME or NAME@SERVER"
                   : "";
    }
    if (raw.models.empty())
    {
        return "a model is required: hrtc FILE.spm, or --model NAME for a published model; see "
               "--help";
    }
    const std::size_t objects = std::max(raw.models.size(), raw.places.size());
    if (objects > kMaxObjects)
    {
        return fmt::format("--place: {} objects; at most {}", objects, kMaxObjects);
    }
    if (raw.materials.size() > objects)
    {
        return fmt::format("--material: {} given for {}", raw.materials.size(),
                           counted(objects, "object"));
    }
    for (std::size_t i = 0; i < objects; ++i)
    {
        const std::string& name = raw.models[std::min(i, raw.models.size() - 1)];
        const auto known = std::ranges::find(options.models, name);
        options.objects.emplace_back().model =
            static_cast<std::size_t>(known - options.models.begin());
        if (known == options.models.end())
        {
            options.models.push_back(name);
        }
    }
    if (options.models.size() > kMaxModels)
    {
        return fmt::format("--model: {} models; at most {}", options.models.size(), kMaxModels);
    }
    if (options.objects_max != 0 && options.objects_max < objects)
    {
        return fmt::format("--objects: {} is less than the {} objects at the start",
                           options.objects_max, objects);
    }
    return {};
}

/// Sets the places of the objects. Returns the fault; empty if none.
std::string check_places(Options& options, const RawOptions& raw)
{
    for (std::size_t i = 0; i < raw.places.size(); ++i)
    {
        const auto place = parse_placement(raw.places[i]);
        if (!place)
        {
            return "--place: " + place.error().text;
        }
        options.objects[i].place = place.value();
        options.objects[i].has_place = true;
    }
    return {};
}

/// Sets the materials of the objects. Returns the fault; empty if none.
std::string check_materials(Options& options, const RawOptions& raw)
{
    for (std::size_t i = 0; i < raw.materials.size() && options.scene.empty(); ++i)
    {
        const auto material = parse_material(raw.materials[i]);
        if (const std::size_t colon = raw.materials[i].find(':'); colon != std::string::npos)
        {
            return fmt::format("--material: '{}': only objects of a --scene have names; give "
                               "materials in the order of the objects: '{}'?",
                               printable(raw.materials[i]),
                               printable(raw.materials[i].substr(colon + 1)));
        }
        if (!material)
        {
            return "--material: " + material.error().text;
        }
        options.objects[i].material = material.value();
        options.objects[i].has_material = true;
    }
    for (std::size_t i = raw.models.size(); i < options.objects.size(); ++i)
    {
        if (i >= raw.materials.size())
        {
            const PlacedObject& last = options.objects[raw.models.size() - 1];
            options.objects[i].material = last.material;
            options.objects[i].has_material = last.has_material;
        }
    }
    return {};
}

/// Fault of --force-shading; empty if none. Called after set_tools().
std::string check_shading(const Options& options)
{
    return options.shading_m > 0.0 && std::ranges::none_of(options.tools, &is_round)
               ? "--force-shading: needs a point or a sphere as --tool"
               : "";
}

/// Fault of --edit; empty if none. Called once the transport is known.
std::string check_edits(const Options& options)
{
    return options.transport == TransportKind::file &&
                   std::ranges::any_of(options.tools, [](const ToolOptions& tool)
                                       { return tool.carve_rate_m3_per_s > 0.0; })
               ? "--edit: only published models can be edited; publish the file with "
                 "'spm_publish FILE --edits'"
               : "";
}

bool has_device(const Options& options, DeviceKind kind)
{
    return std::ranges::any_of(options.tools, [kind](const ToolOptions& tool)
                               { return tool.device.kind == kind; });
}

/// Fault of --device-key; empty if none.
std::string check_device_key(const Options& options, const RawOptions& raw)
{
    return !raw.device_key || has_device(options, DeviceKind::udp)
               ? ""
               : "--device-key: there is no udp device";
}

/// Gives all UDP devices the key of the file. Called once the options are valid, because a bad file
/// is no wrong usage. Returns the fault; empty if none.
std::string set_device_key(Options& options, const RawOptions& raw)
{
    if (!raw.device_key)
    {
        return {};
    }
    const auto authenticator = read_device_key(*raw.device_key);
    if (!authenticator)
    {
        return authenticator.error().text;
    }
    for (ToolOptions& tool : options.tools)
    {
        tool.device.authenticator =
            tool.device.kind == DeviceKind::udp ? authenticator.value() : nullptr;
    }
    return {};
}

/// Sets the device faults. Called after set_tools(). Returns the fault; empty if none.
std::string check_faults(Options& options, const RawOptions& raw)
{
    if (raw.device_faults.size() > kDeviceFaultsMax)
    {
        return fmt::format("--device-fault: at most {} faults", kDeviceFaultsMax);
    }
    for (const std::string& text : raw.device_faults)
    {
        const std::optional<DeviceFault> fault = parse_device_fault(text);
        if (!fault)
        {
            return fmt::format("--device-fault: '{}' is not {}", printable(text),
                               kDeviceFaultForms);
        }
        options.device_faults.push_back(*fault);
    }
    return raw.device_faults.empty() || has_device(options, DeviceKind::simulated)
               ? ""
               : "--device-fault: there is no simulated device";
}

/// Checks the names of the controller and of published models. Returns the fault; empty if none.
std::string check_names(const CommandLine& line, const Options& options)
{
    if (!options.is_watched)
    {
        return {};
    }
    if (line.is_given("--name") && !is_valid_name(options.name))
    {
        return fmt::format("--name: '{}' is not {}", printable(options.name), kNameForm);
    }
    if (options.transport == TransportKind::file)
    {
        return {};
    }
    for (const std::string& model : options.models)
    {
        if (const auto selector = parse_selector(model); !selector)
        {
            return "--model: " + selector.error().text;
        }
    }
    for (std::size_t i = 0; i < options.tools.size(); ++i)
    {
        const std::string model = options.tools[i].mesh_model();
        if (const auto selector = parse_selector(model); !model.empty() && !selector)
        {
            return options.of_tool("--tool", i) + ": " + selector.error().text;
        }
    }
    return {};
}

/// Sets the failover servers. Returns the fault; empty if none.
std::string set_failover(Options& options, const RawOptions& raw)
{
    if (!raw.failover.empty() && options.transport == TransportKind::file)
    {
        return "--failover: models from files have no server";
    }
    for (const std::string& server : raw.failover)
    {
        if (!is_valid_server(server))
        {
            return fmt::format("--failover: '{}' is not MACHINE[:PROCESS], cert: with 12 "
                               "hexadecimal digits (0-9 a-f), or any",
                               printable(server));
        }
        if (server == "any")
        {
            options.failover.any = true;
        }
        else
        {
            options.failover.servers.push_back(server);
        }
    }
    return {};
}

/// Checks memory and work of a frame. Returns the fault; empty if none.
std::string check_budgets(const CommandLine& line, Options& options)
{
    if (line.is_given("--cache-mib") && options.cache_mib >= options.pool_mib)
    {
        return "--cache-mib: must be less than --pool-mib";
    }
    const double period_us = 1e6 / static_cast<double>(options.rate_hz);
    if (options.frame_budget_us && *options.frame_budget_us >= period_us)
    {
        return fmt::format("--frame-budget-us: must be less than the period of {} us", period_us);
    }
    const std::uint32_t times = options.work_times();
    const double least_us = 1e-3 * Budgets::least_work(times) / times;
    if (options.frame_budget_us && *options.frame_budget_us < least_us)
    {
        return fmt::format(
            "--frame-budget-us: a tool that is a hull or a mesh needs at least {} us", least_us);
    }
    if (options.frame_budget_us && !line.is_given("--splits"))
    {
        options.splits = kMaxSplitsPerFrame;
    }
    return {};
}

/// Checks --virtual-time, which needs models from files and simulated or recorded devices. Returns
/// the fault; empty if none.
std::string check_virtual_time(Options& options, const RawOptions& raw)
{
    if (!options.virtual_time)
    {
        return {};
    }
    if (options.transport != TransportKind::file)
    {
        return "--virtual-time: models must be files; servers run in real time";
    }
    if (has_device(options, DeviceKind::udp) || has_device(options, DeviceKind::dhd) ||
        has_device(options, DeviceKind::plugin))
    {
        return "--virtual-time: devices must be simulated or replayed; others run in real time";
    }
    if (!options.trace_path.empty() || !options.histograms_folder.empty())
    {
        return fmt::format("--virtual-time: {} would have no times",
                           options.trace_path.empty() ? "--histograms" : "--trace");
    }
    // The default of --priority is accepted, because --print-config prints it.
    const char* of_real_time = raw.cpu                      ? "--cpu"
                               : options.supervisor_periods ? "--supervisor-periods"
                               : options.thread.priority != RtThreadOptions{}.priority
                                   ? "--priority"
                                   : nullptr;
    if (of_real_time != nullptr)
    {
        return fmt::format("--virtual-time: {} has no effect without a real-time thread",
                           of_real_time);
    }
    options.thread.is_realtime = false;
    options.thread.lock_memory = false;
    options.thread.processors_awake = false;
    return {};
}

/// Chooses the kernels. Returns the fault; empty if none.
std::string check_kernels(Options& options, const RawOptions& raw)
{
    if (!raw.kernels)
    {
        return {};
    }
    const auto chosen = choose_kernels(*raw.kernels, available_kernels());
    if (!chosen)
    {
        return chosen.error().text;
    }
    options.kernels = chosen.value();
    return {};
}

/// Sets the transport and what depends on it. Returns the fault; empty if none.
std::string set_transport(const CommandLine& line, Options& options, const RawOptions& raw)
{
    options.transport = raw.transport == "file" ? TransportKind::file : TransportKind::dds;
    if (std::string fault = check_edits(options); !fault.empty())
    {
        return fault;
    }
    const bool is_shown = line.is_given("--domain") && !options.virtual_time;
    options.is_watched = options.transport == TransportKind::dds || is_shown;
    if (line.is_given("--domain") && !options.is_watched)
    {
        log_message(LogLevel::info, "hrtc", "note: --domain has no effect with --virtual-time");
    }
    return {};
}

/// Parts of a command line that the checks below need.
struct Parsed
{
    const CommandLine& line;
    Options& options;
    RawOptions& raw;
    const CommandForm& form;
};

using OptionCheck = std::string (*)(const Parsed&);

/// Checks of the options, in this order: a check may use the values set by earlier ones. Each
/// returns its fault; empty if there is none.
constexpr OptionCheck kOfReplay[] = {
    [](const Parsed& p) { return check_files(p.line, p.options); },
    [](const Parsed& p) { return check_kernels(p.options, p.raw); },
    [](const Parsed& p) { return check_replay(p.line); },
};
constexpr OptionCheck kOfRun[] = {
    [](const Parsed& p) { return check_files(p.line, p.options); },
    [](const Parsed& p) { return check_kernels(p.options, p.raw); },
    [](const Parsed& p) { return set_tools(p.options, p.raw); },
    [](const Parsed& p) { return assign_files(p.options, p.raw, p.form.commands); },
    [](const Parsed& p) { return check_models(p.options, p.raw); },
    [](const Parsed& p) { return check_places(p.options, p.raw); },
    [](const Parsed& p) { return check_materials(p.options, p.raw); },
    [](const Parsed& p) { return check_shading(p.options); },
    [](const Parsed& p) { return check_device_key(p.options, p.raw); },
    [](const Parsed& p) { return check_faults(p.options, p.raw); },
    [](const Parsed& p) { return check_budgets(p.line, p.options); },
    [](const Parsed& p) { return set_transport(p.line, p.options, p.raw); },
    [](const Parsed& p) { return check_virtual_time(p.options, p.raw); },
    [](const Parsed& p) { return set_failover(p.options, p.raw); },
    [](const Parsed& p) { return check_names(p.line, p.options); },
};

/// Runs all checks up to the first fault, and returns it; empty if there is none.
std::string check_together(const Parsed& parsed)
{
    const bool is_replay = !parsed.options.replay_path.empty();
    for (const OptionCheck check :
         is_replay ? std::span<const OptionCheck>(kOfReplay) : std::span<const OptionCheck>(kOfRun))
    {
        if (std::string fault = check(parsed); !fault.empty())
        {
            return fault;
        }
    }
    return {};
}

} // namespace

bool is_page_name(const std::string& path)
{
    return path.ends_with(".html");
}

std::variant<Options, int> parse_options(int argc, char** argv, const CommandForm& form)
{
    CommandLine line(form.name, form.description);
    Options options;
    options.duration_s = form.duration_s;
    options.readers = form.readers;
    RawOptions raw;
    declare_options(line, options, raw, form);
    if (const std::optional<int> code = line.parse(argc, argv))
    {
        return *code;
    }
    if (const std::string fault = check_together({line, options, raw, form}); !fault.empty())
    {
        return line.fail(fault, kExitUsage);
    }
    if (const std::string fault = set_device_key(options, raw); !fault.empty())
    {
        return line.fail(fault);
    }
    options.prediction = static_cast<Prediction>(
        std::ranges::find(kPredictionNames, raw.prediction) - kPredictionNames.begin());
    options.thread.cpu = raw.cpu;
    options.follows_poses = !raw.ignores_poses;
    options.shows_refinement_state = !raw.hides_refinement_state;
    options.static_when_it_fits = !raw.refines_always;
    options.as_file = option_file(line, options, raw);
    if (raw.prints_config)
    {
        fmt::print("{}", options.as_file);
        return std::fflush(stdout) == 0 ? kExitDone : line.fail("the options can't be written");
    }
    return options;
}

RunHooks program_hooks()
{
    return {.is_stopped = is_stop_requested,
            .begin_progress = [](const std::string& what) -> FramesDone
            {
                auto progress = std::make_shared<Progress>("hrtc", what, "frames");
                return [progress](std::uint64_t done, std::uint64_t all)
                { progress->update(done, all); };
            },
            .notifies_manager = true};
}

} // namespace tactus::hrtc
