// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "host_tools/tactus/programs.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::tactus_program
{

namespace
{

/// Option that another program takes as it is.
struct Passed
{
    const char* name;
    const char* description;
    std::string value{}; ///< Empty: not given.
};

struct Options
{
    std::string mesh;
    bool is_centered{false};
    bool has_no_view{false};
    bool is_plain{false};
    std::vector<std::string> reports;
    std::vector<std::string> others; ///< Further options of hrtc.
    std::vector<Passed> of_build{
        {"--unit", "Unit of the mesh's coordinates: mm, cm, m or in [default: m]"},
        {"--scale", "Factor of the size of the mesh [default: 1]"},
        {"--fit-diag", "Bounding-box diagonal to which the mesh is scaled, in metres"},
        {"--up", "Axis of the mesh that points up, y or z [default: z]"},
    };
    std::vector<Passed> of_run{
        {"--tool", "Shape of the tool [default: a sphere with a radius of 1 % of the diagonal]"},
        {"--device", "Device that moves the tool [default: sim]"},
        {"--motion", "Motion of a simulated operator [default: script]"},
        {"--material", "Material of the model [default: that of hrtc]"},
        {"--stiffness", "Stiffness of the virtual wall, in N/m [default: 500]"},
        {"--duration", "Duration of the run, in seconds [default: 60, with --no-view 10]"},
    };
    std::vector<Passed> of_network{
        {"--domain", "DDS domain of the view [default: 0]", "0"},
        {"--security", "Folder of keys for that domain [default: none]"},
    };
};

void declare_options(CommandLine& line, Options& options)
{
    const auto declare = [&](std::vector<Passed>& all)
    {
        for (Passed& each : all)
        {
            line.add_option(each.name, each.value, each.description);
        }
    };
    line.begin_task("Model", "tactus touch statue.obj --unit mm");
    line.add_option("MESH", options.mesh,
                    "Mesh to touch (.ply, .obj, .stl or .off), or model (.spm)")
        .required();
    declare(options.of_build);
    line.add_flag("--center", options.is_centered,
                  "Move the centre of the bounding box of the mesh to the origin");
    line.begin_task("Run", "tactus touch statue.obj --tool sphere:0.002 -- --pool-mib 8");
    line.add_option("OPTION", options.others, "Further options of hrtc, after --");
    declare(options.of_run);
    line.begin_task("View and report", "tactus touch statue.obj --no-view --report run.json");
    line.add_flag("--no-view", options.has_no_view, "Do not serve the live view");
    declare(options.of_network);
    line.add_flag("--plain", options.is_plain, "Join a network of CYCLONEDDS_URI without keys");
    line.add_option("--report", options.reports,
                    "File for the report: JSON if the name ends in .json, an HTML page if the name "
                    "ends in .html. Repeatable [default: MESH's name and .report.html]")
        .repeatable();
}

void append(std::vector<std::string>& arguments, const std::vector<Passed>& options)
{
    for (const Passed& each : options)
    {
        if (!each.value.empty())
        {
            arguments.push_back(fmt::format("{}={}", each.name, each.value));
        }
    }
}

std::vector<std::string> arguments_of_build(const Options& options)
{
    std::vector<std::string> arguments;
    append(arguments, options.of_build);
    if (options.is_centered)
    {
        arguments.emplace_back("--center");
    }
    return arguments;
}

/// Arguments for the domain that the view and the run share.
std::vector<std::string> arguments_of_network(const Options& options)
{
    std::vector<std::string> arguments;
    append(arguments, options.of_network);
    if (options.is_plain)
    {
        arguments.emplace_back("--plain");
    }
    return arguments;
}

std::vector<std::string> arguments_of_run(const Options& options, const std::string& model)
{
    std::vector<std::string> arguments =
        options.has_no_view ? std::vector<std::string>{} : arguments_of_network(options);
    append(arguments, options.of_run);
    arguments.insert(arguments.end(), options.others.begin(), options.others.end());
    const auto has = [&](const std::string& option)
    {
        return std::ranges::any_of(arguments, [&](const std::string& word)
                                   { return word == option || word.starts_with(option + "="); });
    };
    const auto is_sim = [](const std::string& word) { return word.starts_with("--device=sim"); };
    const bool is_simulated = !has("--device") || std::ranges::any_of(arguments, is_sim);
    if (is_simulated && !has("--allow-no-rt") && !has("--config"))
    {
        arguments.emplace_back("--allow-no-rt"); // The first touch needs no rights.
    }
    if (!options.has_no_view && !has("--duration") && !has("--config"))
    {
        arguments.emplace_back("--duration=60");
    }
    for (const std::string& report : options.reports)
    {
        arguments.push_back("--report=" + report);
    }
    if (options.reports.empty())
    {
        const auto name = std::filesystem::path(options.mesh).stem().string();
        arguments.push_back(fmt::format("--report={}.report.html", name));
    }
    arguments.insert(arguments.end(), {"--", model});
    return arguments;
}

/// Fault of the options that the other programs would not report; empty if there is none.
std::string fault_of(const Options& options, bool is_model)
{
    const std::string& mesh = options.mesh;
    if (mesh.ends_with(".gltf") || mesh.ends_with(".glb"))
    {
        return fmt::format("MESH: '{0}' is a scene; build it with: tactus build {0} -o FOLDER",
                           mesh);
    }
    return is_model && !arguments_of_build(options).empty()
               ? fmt::format("MESH: '{}' is a model; the options of meshes have no effect", mesh)
               : "";
}

} // namespace

int touch(int argc, char** argv)
{
    CommandLine line("tactus touch", "Builds the model of a mesh once, touches it, shows the run "
                                     "in a browser and writes a report.");
    Options options;
    declare_options(line, options);
    if (const auto code = line.parse(argc, argv))
    {
        return *code;
    }
    const bool is_model = options.mesh.ends_with(".spm");
    if (const auto fault = fault_of(options, is_model); !fault.empty())
    {
        return line.fail(fault, kExitUsage);
    }
    for (const auto& [program, is_needed] :
         {std::pair("spm_build", !is_model), std::pair("spm_view", !options.has_no_view),
          std::pair("hrtc", true)})
    {
        if (const auto fault = is_needed ? fault_of_program(program) : std::nullopt)
        {
            return line.fail(fault->text);
        }
    }
    stop_on_signals();
    const auto model = is_model ? std::variant<std::string, int>(options.mesh)
                                : cached_model(line, options.mesh, arguments_of_build(options));
    if (const int* code = std::get_if<int>(&model))
    {
        return *code;
    }
    const auto& path = std::get<std::string>(model);
    pid_t view = -1;
    if (!options.has_no_view)
    {
        std::vector<std::string> arguments = arguments_of_network(options);
        arguments.insert(arguments.end(), {"--port=0", "--", path});
        view = start("spm_view", std::move(arguments)); // It prints its address.
    }
    const int code = wait_for(start("hrtc", arguments_of_run(options, path)));
    if (view > 0)
    {
        ::kill(view, SIGTERM);
        static_cast<void>(wait_for(view));
    }
    return code;
}

} // namespace tactus::tactus_program
