// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/options.hpp"

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "platform/program/command_line.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace tactus::spm_build
{

namespace
{

/// Options that are kept as words.
struct Words
{
    std::string format;
    std::string up{"z"};
};

void declare_options(CommandLine& line, Options& options, Words& words)
{
    line.add_version("spm_build " TACTUS_VERSION);
    line.begin_task("From what to where", "spm_build part.stl --unit mm -o part.spm");
    const auto input = line.add_option(
        "IN", options.input,
        "Mesh to read: .ply, .obj, .stl or .off, or - for standard input; or scene: .gltf or .glb");
    line.add_option("-o,--output", options.output,
                    "Model to write (.spm); of a scene the folder for its "
                    "models and scene.gltf")
        .required();
    const std::vector<std::string_view> names = shape_names();
    const auto shape =
        line.add_option("--shape", options.shape, "Make a shape instead of reading a mesh")
            .one_of({names.begin(), names.end()})
            .excludes(input);
    const auto faces = line.add_option("--faces", options.shape_faces, "Faces of the shape")
                           .number_between(kMinShapeFaces, kMaxShapeFaces)
                           .needs(shape);
    shape.needs(faces);
    line.add_option("--format", words.format,
                    "Format of a mesh whose name doesn't tell it; with it, IN may be a pipe")
        .one_of({"ply", "obj", "stl", "off"})
        .excludes(shape);
    line.begin_task("Size and place", "spm_build terrain.ply --fit-diag 0.2 --center -o t.spm");
    const auto unit =
        line.add_option("--unit", options.unit, "Unit of the mesh's coordinates")
            .check([](const std::string& name)
                   { return metres_per_unit(name) ? "" : "'" + name + "' is not mm, cm, m or in"; },
                   "mm|cm|m|in")
            .show_default();
    const auto scale = line.add_option("--scale", options.placing.scale,
                                       "Make the mesh, or all of a scene, so many times as large")
                           .number_between(1e-9, 1e9)
                           .show_default();
    line.add_option("--fit-diag", options.model.fit_diagonal_m,
                    "Scale the model to this bounding-box diagonal, in metres, whatever its size")
        .number_between(kMinDiagonal_m, kMaxDiagonal_m)
        .excludes(unit)
        .excludes(scale);
    line.add_option("--up", words.up,
                    "Axis of the mesh or scene that points up; y is turned to z, which is up for "
                    "devices")
        .one_of({"y", "z"})
        .show_default();
    line.add_flag("--center", options.placing.is_centered,
                  "Move the middle of the box round the mesh, or all of a scene, to the origin");
    line.begin_task("Inside and outside", "spm_build part.stl --keep-winding -o part.spm");
    line.add_flag("--keep-winding", options.model.keeps_winding,
                  "Leave closed pieces as they are that look inside out");
    line.begin_task("Encoding", "spm_build part.stl --unit mm --position-bits 20 -o part.spm");
    line.add_option("--position-bits", options.model.position_bits,
                    "Bits of a coordinate [16, more where the mesh has finer detail]")
        .number_between(kMinPositionBits, kMaxPositionBits);
    line.add_option("--base-faces", options.model.base_faces,
                    "Faces of the coarsest mesh, at most; more where pieces, holes or handles keep "
                    "it from shrinking")
        .number_between(1, kMaxBaseFaces)
        .show_default();
    line.add_option("--region-size", options.model.region_size_m,
                    "Edge of a region in metres, rounded down to a power of two quanta")
        .number_between(1e-12, 1e6);
    line.add_option("--threads", options.model.threads, "Threads to work with")
        .number_between(1, 1024)
        .show_default();
    line.add_option("--memory-mib", options.model.memory_mib,
                    "Refuse what needs more memory [what is available]")
        .integer_between(std::uint32_t{1}, std::uint32_t{1} << 30U);
    line.add_flag("--json", options.json, "Print the figures as one JSON object");
    line.add_log_options();
}

/// Fault of a combination of options; empty if there is none.
std::string check_together(const CommandLine& line, const Options& options)
{
    if (options.input.empty() && options.shape.empty())
    {
        return "give a mesh to read, or --shape and --faces; see --help";
    }
    if (options.input == "-" && !options.format)
    {
        return "--format is required: standard input has no name that ends in its format";
    }
    if (!options.is_of_scene())
    {
        return options.output.ends_with(".spm")
                   ? ""
                   : fmt::format("--output: '{}' is the name of no model; one ends in .spm",
                                 options.output);
    }
    for (const char* name : {"--unit", "--fit-diag"})
    {
        if (line.is_given(name))
        {
            return fmt::format("{}: a glTF scene is in metres; --scale sizes it", name);
        }
    }
    return options.output.ends_with(".spm")
               ? "--output: a glTF scene needs a folder, which gets its models"
               : "";
}

} // namespace

bool Options::is_of_scene() const
{
    return !format && has_scene_extension(input);
}

std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv)
{
    Options options;
    Words words;
    declare_options(line, options, words);
    if (const auto code = line.parse(argc, argv))
    {
        return *code;
    }
    options.format = mesh_format(words.format);
    if (const std::string fault = check_together(line, options); !fault.empty())
    {
        return line.fail(fault, kExitUsage);
    }
    options.model.metres_per_unit = *metres_per_unit(options.unit);
    if (!options.is_of_scene()) // Placing applies to the objects of a scene, not to its models.
    {
        options.model.metres_per_unit *= options.placing.scale;
        options.model.is_centered = options.placing.is_centered;
    }
    options.placing.is_y_up = words.up == "y";
    return options;
}

} // namespace tactus::spm_build
