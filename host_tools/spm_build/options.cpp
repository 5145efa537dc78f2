// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/options.hpp"

#include "host_tools/cli/command_line.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/shapes/shapes.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace tactus::spm_build
{

namespace
{

void declare_options(CommandLine& line, Options& options)
{
    line.add_version("spm_build " TACTUS_VERSION);
    line.begin_task("From what to where", "spm_build part.stl --unit mm -o part.spm");
    const auto input = line.add_option(
        "IN", options.input, "Mesh to read: .ply, .obj, .stl or .off; or scene: .gltf or .glb");
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
    line.begin_task("Size", "spm_build scan.ply --fit-diag 0.2 -o scan.spm");
    const auto unit =
        line.add_option("--unit", options.unit, "Unit of the mesh's coordinates")
            .check([](const std::string& name)
                   { return metres_per_unit(name) ? "" : "'" + name + "' is not mm, cm, m or in"; },
                   "mm|cm|m|in")
            .show_default();
    line.add_option("--fit-diag", options.model.fit_diagonal_m,
                    "Scale the model to this bounding-box diagonal, in metres, whatever its size")
        .number_between(kMinDiagonal_m, kMaxDiagonal_m)
        .excludes(unit);
    line.begin_task("Inside and outside", "spm_build part.stl --keep-winding -o part.spm");
    line.add_flag("--keep-winding", options.model.keeps_winding,
                  "Leave closed pieces as they are that look inside out");
    line.begin_task("Encoding", "spm_build part.stl --unit mm --position-bits 20 -o part.spm");
    line.add_option("--position-bits", options.model.position_bits, "Bits of a coordinate")
        .number_between(kMinPositionBits, kMaxPositionBits)
        .show_default();
    line.add_option("--base-faces", options.model.base_faces, "Faces of the coarsest mesh, at most")
        .number_between(1, kMaxBaseFaces)
        .show_default();
    line.add_option("--region-size", options.model.region_size_m,
                    "Edge of a region in metres, rounded down to a power of two quanta")
        .number_between(1e-12, 1e6);
    line.add_option("--threads", options.model.threads, "Threads to work with")
        .number_between(1, 1024)
        .show_default();
    line.add_flag("--json", options.json, "Print the figures as one JSON object");
    line.add_log_options();
}

/// What one option alone can't tell. Empty when all is well.
std::string check_together(const CommandLine& line, const Options& options)
{
    if (options.input.empty() && options.shape.empty())
    {
        return "give a mesh to read, or --shape and --faces; see --help";
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
            return fmt::format("{}: a glTF scene is in metres", name);
        }
    }
    return options.output.ends_with(".spm")
               ? "--output: a glTF scene needs a folder, which gets its models"
               : "";
}

} // namespace

bool Options::is_of_scene() const
{
    return has_scene_extension(input);
}

std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv)
{
    Options options;
    declare_options(line, options);
    if (const auto code = line.parse(argc, argv))
    {
        return *code;
    }
    if (const std::string fault = check_together(line, options); !fault.empty())
    {
        return line.fail(fault, kExitUsage);
    }
    options.model.metres_per_unit = *metres_per_unit(options.unit);
    return options;
}

} // namespace tactus::spm_build
