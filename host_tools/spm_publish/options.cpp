// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/options.hpp"

#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/spm_publish/pose_script.hpp"
#include "platform/program/command_line.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/printable.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/edit_publisher.hpp"
#include "transport/material_text.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace tactus::spm_publish
{

namespace
{

void declare_options(CommandLine& line, Options& options)
{
    line.add_version("spm_publish " TACTUS_VERSION);
    line.begin_task("Models and names", "spm_publish ball.spm --name toy --domain 7");
    line.add_option(
            "FILE", options.files,
            "Models to serve (.spm), or one scene (.gltf, .glb) whose objects name their models")
        .required();
    line.add_option(
            "--name", options.names,
            "Names of the first model, of the second, ... [default: each file's name without .spm]")
        .repeatable_with_more();
    line.add_option("--scene", options.scene,
                    "Name of the scene of all objects, for hrtc --scene [default: the scene file's "
                    "name without .gltf or .glb]");
    line.add_option("--domain", options.domain, "DDS domain")
        .integer_between(std::uint32_t{0}, dds::kMaxDomain)
        .show_default();
    line.add_security_options(options.security);
    line.add_option_file("--config", "TOML file with options; the command line overrides the file");
    line.begin_task("The run", "spm_publish ball.spm --watch --seconds 60");
    line.add_option("--seconds,--duration", options.seconds,
                    "Duration of the run, in seconds [default: no limit]")
        .number_between(0.1, 1e9);
    line.add_flag("--watch", options.watch,
                  "Print each second the state of each controller in the domain, the data sent to "
                  "each, and the participants whose data was refused");
    line.add_option("--metrics", options.metrics_port,
                    "Port of 127.0.0.1 for Prometheus; 0 selects a free port. /metrics reports the "
                    "served models and the state of each controller in the domain [default: none]")
        .integer_between(std::uint32_t{0}, std::uint32_t{65'535});
    line.begin_task("Edits", "spm_publish ball.spm --edits --save carved.spm");
    line.add_flag("--edits", options.has_edits,
                  "Let controllers change the models, as 'hrtc --edit' does. Needs about 300 bytes "
                  "a face. On this machine's loopback interface every controller may edit; with "
                  "--security those whose certificates permit it");
    line.add_option("--edits-from", options.editors,
                    "Controllers that may edit: MACHINE or MACHINE:PROCESS, or with --security the "
                    "name of a certificate or cert:HEX. The value any allows every controller "
                    "[default: see --edits; with --plain none]")
        .repeatable_with_more();
    line.add_option("--edit-room", options.edit_room,
                    fmt::format("Number of faces that edits may add to each model, at most {} "
                                "[default: {}]",
                                kMaxAddedFaces, dds::kUsualEditRoom))
        .integer_between(std::uint32_t{1}, kMaxAddedFaces);
    line.add_option("--save", options.save_path,
                    "File for the edited model, written at the end of the run if there were edits: "
                    "the whole file or none. May be the file that is served");
    line.begin_task("Moving objects", "spm_publish ball.spm --poses path.txt --poses-loop");
    line.add_option(
        "--poses", options.poses_path,
        fmt::format(
            "Text file of poses that move objects in real time: lines {} in order of time, in s "
            "and m, with a unit quaternion. NAME is an object of the scene or a model. Without "
            "SCALE the object keeps its scale. '{}' in place of the numbers removes the object. "
            "'{}' and then {} sets another material. # begins a comment",
            kPoseLineForm, kGoneWord, kMaterialWord, kMaterialKeysForm));
    line.add_flag("--poses-loop", options.poses_loop,
                  "Repeat the file; each repetition begins at the time of the last line");
    line.add_option("--poses-rate", options.poses_rate_hz,
                    "Rate of interpolated poses between the lines of an object, in poses a second "
                    "[default: none, an object stands still between its lines]")
        .number_between(kPosesRateMin_hz, kPosesRateMax_hz);
    line.add_log_options();
}

/// Fault of the file arguments: none, or an option that does not apply to a scene; empty if
/// correct.
std::string check_files(const Options& options)
{
    for (const std::string& file : options.files)
    {
        if (is_mesh_file_name(file))
        {
            return "FILE: " + mesh_is_no_model(file);
        }
    }
    if (options.has_scene && (options.files.size() > 1 || !options.names.empty()))
    {
        const auto other = std::ranges::find_if_not(options.files, has_scene_extension);
        return options.names.empty() && other != options.files.end()
                   ? fmt::format("FILE: a scene is served alone; serve {0} by another program: "
                                 "'spm_publish {0}{1}'",
                                 printable(*other),
                                 options.domain == 0 ? ""
                                                     : fmt::format(" --domain {}", options.domain))
                   : fmt::format("{}: a scene is served alone, and its models have the names of "
                                 "their files",
                                 options.names.empty() ? "FILE" : "--name");
    }
    return "";
}

/// Sets the names of the models or of the scene; returns the fault, or an empty text.
std::string set_names(Options& options)
{
    if (options.has_scene)
    {
        if (options.scene.empty())
        {
            options.scene = std::filesystem::path(options.files.front()).stem().string();
        }
        return ""; // The names of its models come from the scene's file.
    }
    auto names = choose_names(options.files, options.names);
    if (!names)
    {
        return names.error().text;
    }
    options.names = std::move(names).value();
    return "";
}

/// Fault of the options of edits; empty if there is none. Sets the usual room.
std::string check_edits(Options& options)
{
    const char* of_edits = !options.editors.empty()     ? "--edits-from"
                           : options.edit_room > 0      ? "--edit-room"
                           : !options.save_path.empty() ? "--save"
                                                        : nullptr;
    if (!options.has_edits)
    {
        return of_edits == nullptr ? "" : fmt::format("{}: needs --edits", of_edits);
    }
    options.edit_room = options.edit_room > 0 ? options.edit_room : dds::kUsualEditRoom;
    if (!options.save_path.empty() && (options.has_scene || options.files.size() > 1))
    {
        return "--save: only one model can be saved; serve it alone";
    }
    for (const std::string& editor : options.editors)
    {
        if (!is_valid_server(editor))
        {
            return fmt::format("--edits-from: '{}' is not MACHINE[:PROCESS], cert: with 12 "
                               "hexadecimal digits (0-9 a-f), or any",
                               printable(editor));
        }
    }
    return "";
}

/// Fault of a combination of options; empty if there is none. Sets the names.
std::string check_together(Options& options)
{
    options.has_scene = std::ranges::any_of(options.files, has_scene_extension);
    if (const std::string fault = check_files(options); !fault.empty())
    {
        return fault;
    }
    if (const std::string fault = set_names(options); !fault.empty())
    {
        return fault;
    }
    if (!options.scene.empty() && !is_valid_name(options.scene))
    {
        return fmt::format("--scene: '{}' is not {}", printable(options.scene), kNameForm);
    }
    if (const std::string fault = check_edits(options); !fault.empty())
    {
        return fault;
    }
    if (options.poses_path.empty() && (options.poses_loop || options.poses_rate_hz))
    {
        return fmt::format("{}: needs --poses",
                           options.poses_loop ? "--poses-loop" : "--poses-rate");
    }
    return "";
}

} // namespace

Result<std::vector<std::string>, Refusal> choose_names(std::span<const std::string> files,
                                                       std::span<const std::string> given)
{
    if (given.size() > files.size())
    {
        return Refusal{
            fmt::format("--name is given {} times for {} files", given.size(), files.size())};
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < files.size(); ++i)
    {
        const std::string& file = files[i];
        const bool is_given = i < given.size();
        const std::string name = is_given ? given[i] : std::filesystem::path(file).stem().string();
        if (!is_valid_name(name))
        {
            return Refusal{fmt::format(
                "{} '{}' is not {}{}", is_given ? "--name" : "the stem of '" + file + "',",
                printable(name), kNameForm, is_given ? "" : "; set a name with --name")};
        }
        for (std::size_t other = 0; other < i; ++other)
        {
            if (names[other] == name)
            {
                return Refusal{fmt::format("'{}' and '{}' would both be published as '{}'; give "
                                           "them different names with --name",
                                           files[other], file, name)};
            }
        }
        names.push_back(name);
    }
    return names;
}

std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv)
{
    Options options;
    declare_options(line, options);
    if (const auto code = line.parse(argc, argv, [&] { return check_together(options); }))
    {
        return *code;
    }
    return options;
}

} // namespace tactus::spm_publish
