// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_inspect/extraction.hpp"

#include "host_tools/cli/command_line.hpp"
#include "host_tools/mesh/write_mesh.hpp"
#include "host_tools/spm_inspect/zone_option.hpp"

#include <fmt/format.h>

#include <limits>

namespace tactus
{

namespace
{

constexpr double kMaxError_m = 1e6;

std::string fault_in_mesh_name(const std::string& name)
{
    return has_mesh_extension(name) ? ""
                                    : fmt::format("'{}' does not end in .ply, .obj or .stl", name);
}

std::string fault_in_zone(const std::string& text)
{
    const auto zone = parse_zone(text);
    return zone ? "" : zone.error().text;
}

constexpr const char* kRule = "--extract writes the coarsest mesh that meets what is asked for. "
                              "Inside --region every face of "
                              "the source is there; outside, the mesh is as coarse as --error "
                              "allows, or --faces, what matters "
                              "most first. --faces counts the whole mesh, region included; a "
                              "region or a base mesh that needs "
                              "more faces gets them, and the region is then surrounded by the "
                              "coarsest mesh. --error 0 is the "
                              "whole source.";

} // namespace

void Extractor::declare_options(CommandLine& line)
{
    const auto extract = line.add_flag(
        "--extract", wanted_, "Write a mesh, coarse or fine as --faces, --error, --region ask");
    const auto faces =
        line.add_option("--faces", request_.faces, "Faces of the extracted mesh, at most")
            .number_between(1, std::numeric_limits<std::uint32_t>::max())
            .needs(extract);
    line.add_option("--error", request_.error_m,
                    "Largest error bound of a face of the extracted mesh, in metres")
        .number_between(0, kMaxError_m)
        .excludes(faces)
        .needs(extract);
    line.add_option("--region", region_,
                    "Full resolution in here: sphere:x,y,z,r or box:x0,y0,z0,x1,y1,z1, in metres "
                    "and the source's frame")
        .check(fault_in_zone)
        .needs(extract);
    const auto output =
        line.add_option("-o,--output", output_, "Mesh to write (.ply, .obj or .stl)")
            .check(fault_in_mesh_name)
            .needs(extract);
    extract.needs(output);
    line.set_footer(kRule);
}

std::optional<std::string> Extractor::wrong_usage() const
{
    if (wanted_ && !request_.faces && !request_.error_m && region_.empty())
    {
        return "--extract needs --faces, --error or --region; see --help";
    }
    return std::nullopt;
}

std::optional<std::string> Extractor::run(const DecodedModel& model) const
{
    ExtractRequest request = request_;
    if (!region_.empty())
    {
        request.zone = parse_zone(region_).value();
    }
    const Extraction extraction = extract(model, request);
    if (const auto written = write_mesh(output_, extraction.mesh); !written)
    {
        return written.error().text;
    }
    fmt::print(stderr, "{}: {} faces\n", output_, extraction.mesh.faces.size());
    fmt::print(stderr, "error bound   {:.3g} m at most\n", extraction.error_max_m);
    if (request.zone)
    {
        fmt::print(stderr, "region        {} faces of the source\n", extraction.zone_faces);
    }
    return std::nullopt;
}

} // namespace tactus
