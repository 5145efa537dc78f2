// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/options.hpp"

#include "host_tools/cli/command_line.hpp"
#include "platform/simulated/simulated_device.hpp"
#include "rt_core/limits.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <sstream>

namespace tactus::hrtc
{

namespace
{

constexpr double kLargestPool_mib = 4'096.0;
constexpr double kFrameBudgetMin_us = 10.0;
constexpr double kFrameBudgetMax_us = 10'000.0;
constexpr double kStiffest_n_per_m = 3'000.0;
constexpr std::size_t kDeviceFaultsMax = 64; ///< Each reading looks at all of them.
constexpr std::string_view kPlacementForm = "X,Y,Z[,RX,RY,RZ[,SCALE]] with at most 1e4 m, 360 "
                                            "degrees and a scale of 1e-3 to 1e3";

/// Reads all of `text` as a finite number.
std::optional<double> parse_number(std::string_view text)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return is_whole && std::abs(value) < 1e300 ? std::optional(value) : std::nullopt;
}

std::optional<std::vector<double>> parse_numbers(std::string_view text)
{
    std::vector<double> numbers;
    for (std::size_t at = 0; at <= text.size();)
    {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const std::optional<double> number = parse_number(text.substr(at, comma - at));
        if (!number)
        {
            return std::nullopt;
        }
        numbers.push_back(*number);
        at = comma + 1;
    }
    return numbers;
}

std::optional<Placement> parse_placement(const std::string& text)
{
    const std::optional<std::vector<double>> numbers = parse_numbers(text);
    if (!numbers || (numbers->size() != 3 && numbers->size() != 6 && numbers->size() != 7))
    {
        return std::nullopt;
    }
    const std::vector<double>& n = *numbers;
    Placement placement;
    placement.translation_m = Vec3(n[0], n[1], n[2]);
    if (n.size() >= 6)
    {
        placement.rotation_deg = Vec3(n[3], n[4], n[5]);
    }
    placement.scale = n.size() == 7 ? n[6] : 1.0;
    const bool in_range = placement.translation_m.cwiseAbs().maxCoeff() <= 1e4 &&
                          placement.rotation_deg.norm() <= 360.0 && placement.scale >= 1e-3 &&
                          placement.scale <= 1e3;
    return in_range ? std::optional(placement) : std::nullopt;
}

/// "STIFFNESS[,STATIC[,DYNAMIC[,DAMPING]]]".
std::optional<Material> parse_material(const std::string& text)
{
    const std::optional<std::vector<double>> numbers = parse_numbers(text);
    if (!numbers || numbers->size() > 4)
    {
        return std::nullopt;
    }
    const auto number = [&numbers](std::size_t i, double otherwise)
    { return i < numbers->size() ? (*numbers)[i] : otherwise; };
    Material material;
    material.stiffness_n_per_m = number(0, 0.0);
    material.static_friction = number(1, 0.0);
    material.dynamic_friction = number(2, material.static_friction);
    material.damping_n_s_per_m = number(3, 0.0);
    const bool in_range =
        material.stiffness_n_per_m >= 1.0 && material.stiffness_n_per_m <= kStiffest_n_per_m &&
        material.dynamic_friction >= 0.0 && material.dynamic_friction <= material.static_friction &&
        material.static_friction <= 3.0 && material.damping_n_s_per_m >= 0.0 &&
        material.damping_n_s_per_m <= 20.0;
    return in_range ? std::optional(material) : std::nullopt;
}

/// "sphere:RADIUS_M".
std::optional<double> parse_tool(std::string_view text)
{
    constexpr std::string_view kSphere = "sphere:";
    if (!text.starts_with(kSphere))
    {
        return std::nullopt;
    }
    const std::optional<double> radius = parse_number(text.substr(kSphere.size()));
    return radius && *radius >= 1e-5 && *radius <= 1.0 ? radius : std::nullopt;
}

/// What CLI11 fills before it is checked as a whole.
struct RawOptions
{
    std::vector<std::string> places;
    std::vector<std::string> materials;
    std::vector<std::string> tools;
    std::vector<std::string> devices;
    std::vector<std::string> device_frames;
    std::vector<std::string> device_faults;
    std::optional<std::string> motion;
    std::string transport{"dds"};
    std::string prediction{prediction_name(Prediction::automatic)};
    std::optional<int> cpu;
    bool prints_config{false};
    bool ignores_poses{false};
};

/// Options without a value are shown as comments: no file could set them to nothing.
std::string without_empty(const std::string& config)
{
    std::istringstream lines(config);
    std::string text;
    for (std::string line; std::getline(lines, line);)
    {
        text += (line.ends_with("=\"\"") ? "# " : "") + line + '\n';
    }
    return text;
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

void declare(CLI::App& app, Options& options, RawOptions& raw)
{
    app.set_version_flag("--version", std::string("hrtc ") + TACTUS_VERSION);
    app.add_option("--model", options.models,
                   "Model to touch: NAME or NAME@HASH as published, or with --transport file a "
                   "path; repeatable")
        ->expected(1)
        ->allow_extra_args(false)
        ->take_all();
    app.add_option("--place", raw.places,
                   "Where the model stands, one for each --model in order: X,Y,Z in m "
                   "[,RX,RY,RZ rotation vector in degrees [,SCALE]]")
        ->expected(1)
        ->allow_extra_args(false)
        ->take_all();
    app.add_option("--material", raw.materials,
                   "How the model feels, one for each --model in order: STIFFNESS in N/m, 1 to "
                   "3000, the softer of this and --stiffness counts [,STATIC friction, 0 to 3 "
                   "[,DYNAMIC friction, at most the static one [,DAMPING in N s/m, 0 to 20]]]")
        ->expected(1)
        ->allow_extra_args(false)
        ->take_all();
    app.add_option("--tool", raw.tools,
                   "Tool: sphere:RADIUS_M, 1e-5 to 1 m; repeatable [one sphere of 1 % of the first "
                   "model's diagonal]")
        ->expected(1)
        ->allow_extra_args(false)
        ->take_all();
    app.add_option("--device", raw.devices,
                   "What moves the tool, one for each --tool in order: sim[:CLASS], a simulated "
                   "hand on a device of the class touch, omega or delta; udp[:[ADDRESS:]PORT], a "
                   "driver of your own; dhd[:INDEX], a device of Force "
                   "Dimension's; replay:FILE, the hand of a recording; repeatable [sim]")
        ->expected(1)
        ->allow_extra_args(false)
        ->take_all();
    app.add_option("--device-frame", raw.device_frames,
                   "Where the device's coordinates are in the world, one for each --device in "
                   "order: as --place, SCALE being that of its motion")
        ->expected(1)
        ->allow_extra_args(false)
        ->take_all();
    app.add_option("--device-fault", raw.device_faults,
                   "For tests: what goes wrong with the readings of simulated devices: "
                   "KIND@FRAME+LENGTH with jitter, dropout, stuck, nan, time_jump or disconnect, "
                   "from that frame on for so many; repeatable")
        ->expected(1)
        ->allow_extra_args(false)
        ->take_all();
    app.add_option("--motion", raw.motion,
                   "What simulated hands do: script, free, approach, slide, tap, teleport, spin or "
                   "tremor [script]");
    app.add_option("--rate", options.rate_hz, "Frames a second")
        ->check(CLI::Range(SimulatedDeviceOptions::kRateMinHz, SimulatedDeviceOptions::kRateMaxHz))
        ->capture_default_str();
    app.add_option("--duration", options.duration_s, "Seconds to run")
        ->check(number_between(0.1, 86'400.0))
        ->capture_default_str();
    app.add_option("--report", options.report_path,
                   "Write the report to this file: a page when its name ends in .html, else JSON");
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

/// Everything that a run could be told is in the recording. Empty when all is well.
std::string check_replay(const CLI::App& app)
{
    for (const CLI::Option* option : app.get_options())
    {
        if (option->count() > 0 && option->get_name() != "--replay")
        {
            return "--replay: takes no other option; " + option->get_name() + " was given";
        }
    }
    return {};
}

std::string check_files(const CLI::App& app, const Options& options)
{
    for (const auto& [name, path] :
         {std::pair("--record", &options.record_path), std::pair("--replay", &options.replay_path)})
    {
        const CLI::Option* option = app.get_option_no_throw(name);
        if (option != nullptr && option->count() > 0 && path->empty())
        {
            return std::string(name) + ": a file's name is needed";
        }
    }
    return !options.record_path.empty() && options.record_path == options.report_path
               ? "--record: must be another file than --report"
               : "";
}

/// The models, and what is given for each of them. Empty when all is well.
std::string check_objects(Options& options, const RawOptions& raw)
{
    const std::size_t models = options.models.size();
    if (models == 0)
    {
        return "--model is required";
    }
    if (models > kMaxObjects)
    {
        return fmt::format("--model: at most {} models", kMaxObjects);
    }
    for (const auto& [name, given] :
         {std::pair("--place", raw.places.size()), std::pair("--material", raw.materials.size())})
    {
        if (given > models)
        {
            return fmt::format("{}: {} given for {} models", name, given, models);
        }
    }
    for (const std::string& text : raw.places)
    {
        const std::optional<Placement> placement = parse_placement(text);
        if (!placement)
        {
            return fmt::format("--place: '{}' is not {}", printable(text), kPlacementForm);
        }
        options.placements.push_back(*placement);
    }
    options.placements.resize(models);
    for (const std::string& text : raw.materials)
    {
        const std::optional<Material> material = parse_material(text);
        if (!material)
        {
            return fmt::format("--material: '{}' is not STIFFNESS[,STATIC[,DYNAMIC[,DAMPING]]] "
                               "with 1 to 3000 N/m, friction of 0 to 3, the dynamic one at most "
                               "the static one, and 0 to 20 N s/m",
                               printable(text));
        }
        options.materials.push_back(*material);
    }
    options.materials.resize(models);
    return {};
}

/// What is said of simulated devices only. Empty when all is well.
std::string check_simulated(Options& options, const RawOptions& raw)
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
    const std::optional<MotionKind> motion = motion_named(raw.motion.value_or("script"));
    if (!motion)
    {
        return fmt::format("--motion: '{}' is not {}", printable(*raw.motion), kMotionNames);
    }
    options.motion = *motion;
    const bool has_others_only =
        options.devices.size() == std::max<std::size_t>(options.tool_radii_m.size(), 1) &&
        std::ranges::none_of(options.devices, [](const DeviceChoice& device)
                             { return device.kind == DeviceKind::simulated; });
    if (has_others_only && (raw.motion || !raw.device_faults.empty()))
    {
        return fmt::format("{}: there is no simulated device",
                           raw.motion ? "--motion" : "--device-fault");
    }
    return {};
}

/// The tools, and what is given for each of them. Empty when all is well.
std::string check_tools(Options& options, const RawOptions& raw)
{
    if (raw.tools.size() > kMaxTools)
    {
        return fmt::format("--tool: at most {} tools", kMaxTools);
    }
    for (const std::string& text : raw.tools)
    {
        const std::optional<double> radius = parse_tool(text);
        if (!radius)
        {
            return fmt::format("--tool: '{}' is not sphere:RADIUS_M with 1e-5 to 1 m",
                               printable(text));
        }
        options.tool_radii_m.push_back(*radius);
    }
    const std::size_t tools = std::max<std::size_t>(raw.tools.size(), 1);
    if (raw.devices.size() > tools)
    {
        return fmt::format("--device: {} given for {} tools", raw.devices.size(), tools);
    }
    if (raw.device_frames.size() > raw.devices.size())
    {
        return fmt::format("--device-frame: {} given for {} of --device", raw.device_frames.size(),
                           raw.devices.size());
    }
    for (const std::string& text : raw.devices)
    {
        const std::optional<DeviceChoice> device = parse_device(text);
        if (!device)
        {
            return fmt::format("--device: '{}' is not {}", printable(text), kDeviceForms);
        }
        options.devices.push_back(*device);
    }
    for (std::size_t i = 0; i < raw.device_frames.size(); ++i)
    {
        const std::optional<Placement> frame = parse_placement(raw.device_frames[i]);
        if (!frame)
        {
            return fmt::format("--device-frame: '{}' is not {}", printable(raw.device_frames[i]),
                               kPlacementForm);
        }
        if (options.devices[i].kind == DeviceKind::simulated ||
            options.devices[i].kind == DeviceKind::replay)
        {
            return "--device-frame: a simulated or recorded hand is in the world already";
        }
        options.devices[i].frame = *frame;
    }
    return check_simulated(options, raw);
}

/// What one option alone can't tell. Empty when all is well.
std::string check_together(const CLI::App& app, Options& options, const RawOptions& raw)
{
    if (const std::string fault = check_files(app, options); !fault.empty())
    {
        return fault;
    }
    if (!options.replay_path.empty())
    {
        return check_replay(app);
    }
    if (const std::string fault = check_objects(options, raw); !fault.empty())
    {
        return fault;
    }
    if (const std::string fault = check_tools(options, raw); !fault.empty())
    {
        return fault;
    }
    if (app.count("--cache-mib") > 0 && options.cache_mib >= options.pool_mib)
    {
        return "--cache-mib: must be less than --pool-mib";
    }
    const double period_us = 1e6 / static_cast<double>(options.rate_hz);
    if (options.frame_budget_us && *options.frame_budget_us >= period_us)
    {
        return fmt::format("--frame-budget-us: must be less than the period of {} us", period_us);
    }
    if (options.frame_budget_us && app.count("--splits") == 0)
    {
        options.splits = kMaxSplitsPerFrame;
    }
    options.prediction = static_cast<Prediction>(
        std::ranges::find(kPredictionNames, raw.prediction) - kPredictionNames.begin());
    options.transport = raw.transport == "file" ? TransportKind::file : TransportKind::dds;
    if (options.transport == TransportKind::dds)
    {
        for (const std::string& model : options.models)
        {
            if (const auto selector = parse_selector(model); !selector)
            {
                return "--model: " + selector.error().text;
            }
        }
    }
    return {};
}

} // namespace

std::variant<Options, int> parse_options(int argc, char** argv, const CommandForm& form)
{
    CLI::App app(form.description, form.name);
    Options options;
    options.duration_s = form.duration_s;
    RawOptions raw;
    declare(app, options, raw);
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
    if (const std::optional<int> code = parse_command_line(app, argc, argv))
    {
        return *code;
    }
    if (const std::string fault = check_together(app, options, raw); !fault.empty())
    {
        return fail(app, fault, kExitUsage);
    }
    options.thread.cpu = raw.cpu;
    options.follows_poses = !raw.ignores_poses;
    if (raw.prints_config)
    {
        fmt::print("{}", without_empty(app.config_to_str(true, true)));
        return std::fflush(stdout) == 0 ? kExitDone : fail(app, "the options can't be written");
    }
    return options;
}

} // namespace tactus::hrtc
