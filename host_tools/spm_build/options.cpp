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

/// Options that are read as text and converted later.
struct Words
{
    std::string format;
    std::string up{"z"};
};

void declare_options(CommandLine& line, Options& options, Words& words)
{
    line.add_version("spm_build " TACTUS_VERSION);
    line.begin_task("Input and output", "spm_build part.stl --unit mm -o part.spm");
    const auto input = line.add_option("IN", options.input,
                                       "Mesh to read (.ply, .obj, .stl or .off, or - for standard "
                                       "input), or scene (.gltf or .glb)");
    line.add_option("-o,--output", options.output,
                    "Model to write (.spm); for a scene, the folder for its models and scene.gltf")
        .required();
    const std::vector<std::string_view> names = shape_names();
    const auto shape =
        line.add_option("--shape", options.shape, "Shape to make instead of reading a mesh")
            .one_of({names.begin(), names.end()})
            .excludes(input);
    const auto faces =
        line.add_option("--faces", options.shape_faces, "Number of faces of the shape")
            .number_between(kMinShapeFaces, kMaxShapeFaces)
            .needs(shape);
    shape.needs(faces);
    line.add_option("--format", words.format,
                    "Format of the mesh if its name does not end in the format; needed for "
                    "standard input and pipes")
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
                                       "Factor of the size of the mesh or of the whole scene")
                           .number_between(1e-9, 1e9)
                           .show_default();
    line.add_option("--fit-diag", options.model.fit_diagonal_m,
                    "Bounding-box diagonal to which the mesh is scaled, in metres")
        .number_between(kMinDiagonal_m, kMaxDiagonal_m)
        .excludes(unit)
        .excludes(scale);
    line.add_option(
            "--up", words.up,
            "Axis of the mesh or scene that points up; y is rotated to z, which is up for devices")
        .one_of({"y", "z"})
        .show_default();
    line.add_flag(
        "--center", options.placing.is_centered,
        "Move the centre of the bounding box of the mesh or of the whole scene to the origin");
    line.begin_task("Orientation of faces", "spm_build part.stl --keep-winding -o part.spm");
    line.add_flag("--keep-winding", options.model.keeps_winding,
                  "Keep the orientation of closed parts that are inside out");
    line.begin_task("Encoding", "spm_build part.stl --unit mm --position-bits 20 -o part.spm");
    line.add_option("--position-bits", options.model.position_bits,
                    "Bits of a coordinate [default: 16, more for a mesh with finer detail]")
        .number_between(kMinPositionBits, kMaxPositionBits);
    line.add_option("--base-faces", options.model.base_faces,
                    "Maximum number of faces of the base mesh; more if parts, holes or handles "
                    "keep it from shrinking")
        .number_between(1, kMaxBaseFaces)
        .show_default();
    line.add_option("--region-size", options.model.region_size_m,
                    "Edge length of a region, rounded down to a power of two quanta, in metres "
                    "[default: at most 16 regions along the longest axis]")
        .number_between(1e-12, 1e6);
    line.add_option("--threads", options.model.threads,
                    "Number of threads [default: the number of processors]")
        .number_between(1, 1024);
    line.add_option("--memory-mib", options.model.memory_mib,
                    "Memory limit, in MiB; a mesh that needs more is refused [default: the "
                    "available memory]")
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
        return "--format is required: standard input has no file name extension";
    }
    if (!options.is_of_scene())
    {
        return options.output.ends_with(".spm")
                   ? ""
                   : fmt::format("--output: '{}' must end in .spm", options.output);
    }
    for (const char* name : {"--unit", "--fit-diag"})
    {
        if (line.is_given(name))
        {
            return fmt::format("{}: a glTF scene is in metres; use --scale instead", name);
        }
    }
    return options.output.ends_with(".spm")
               ? "--output: a glTF scene needs a folder for its models, not an .spm file"
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
    const auto find_fault = [&]
    {
        options.format = mesh_format(words.format);
        return check_together(line, options);
    };
    if (const auto code = line.parse(argc, argv, find_fault))
    {
        return *code;
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
