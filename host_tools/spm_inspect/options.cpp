// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_inspect/options.hpp"

#include "host_tools/encode/zone.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/mesh/write_mesh.hpp"
#include "platform/program/command_line.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/program_log.hpp"
#include "transport/base/refusal.hpp"

#include <fmt/format.h>

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

namespace
{

/// Limits of a zone's coordinates and radius, in metres.
constexpr double kMaxZoneCoordinate_m = 1e9;
constexpr double kMinZoneRadius_m = 1e-9;

constexpr NumberRange kAlong{-kMaxZoneCoordinate_m, kMaxZoneCoordinate_m, "m"};
constexpr NumberRange kOfSphere[] = {
    kAlong, kAlong, kAlong, {kMinZoneRadius_m, kMaxZoneCoordinate_m, "m"}};
constexpr NumberRange kOfBox[] = {kAlong, kAlong, kAlong, kAlong, kAlong, kAlong};
constexpr NumberForm kSphere{"sphere:x,y,z,r", kOfSphere};
constexpr NumberForm kBox{"box:x0,y0,z0,x1,y1,z1", kOfBox};

Result<Zone, Refusal> parse_sphere(std::string_view text)
{
    const auto numbers = read_numbers(text, kSphere);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    return Zone{SphereZone{{n[0], n[1], n[2]}, n[3]}};
}

Result<Zone, Refusal> parse_box(std::string_view text)
{
    const auto numbers = read_numbers(text, kBox);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (n[3 + axis] < n[axis])
        {
            return not_of_form(
                text, kBox.text,
                fmt::format("{0}1 is {1}, less than {0}0, {2}", "xyz"[axis], n[3 + axis], n[axis]));
        }
    }
    return Zone{BoxZone{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}}};
}

/// Reads sphere:x,y,z,r or box:x0,y0,z0,x1,y1,z1. Numbers are plain decimals without spaces; a
/// box's second corner must not be below its first on any axis.
Result<Zone, Refusal> parse_zone(std::string_view text)
{
    if (text.starts_with("sphere:"))
    {
        return parse_sphere(text);
    }
    if (text.starts_with("box:"))
    {
        return parse_box(text);
    }
    return Refusal{
        fmt::format("'{}' is neither {} nor {}", printable(text), kSphere.text, kBox.text)};
}

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

std::string bounds_text(const ModelHeader& header)
{
    const HeaderFields& fields = header.fields();
    std::string text;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double low_m = fields.origin_m[axis];
        const double high_m =
            low_m + fields.extent_quanta[axis] * static_cast<double>(header.quantum_m());
        text +=
            fmt::format("{}{} {:.6g} .. {:.6g}", axis == 0 ? "" : ", ", "xyz"[axis], low_m, high_m);
    }
    return text + " m";
}

constexpr const char* kRule =
    "--extract writes the coarsest mesh that meets the requests. Inside --region the mesh has "
    "every face of the source. Outside, the mesh is as coarse as --error allows, or is refined up "
    "to --faces, with the most important vertex splits first. --faces counts the whole mesh with "
    "the region. If a region or a base mesh needs more faces, the mesh has these faces, and is the "
    "coarsest one outside the region. --error 0 gives the whole source.";

} // namespace

void Extractor::declare_options(CommandLine& line)
{
    line.begin_task("Extracted mesh", "spm_inspect ball.spm --extract --error 0.0005 -o ball.stl");
    const auto extract = line.add_flag(
        "--extract", wanted_, "Write a mesh as fine as --faces, --error and --region request");
    const auto faces =
        line.add_option("--faces", request_.faces, "Maximum number of faces of the extracted mesh")
            .number_between(1, std::numeric_limits<std::uint32_t>::max())
            .needs(extract);
    line.add_option("--error", request_.error_m,
                    "Largest error bound of a face of the extracted mesh, in metres")
        .number_between(0, kMaxError_m)
        .excludes(faces)
        .needs(extract);
    line.add_option("--region", region_,
                    "Zone of full resolution: sphere:x,y,z,r or box:x0,y0,z0,x1,y1,z1, in metres, "
                    "in the source's frame")
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
    if (request.zone && extraction.zone_faces == 0)
    {
        return "--region: the region meets no face of the model, whose bounds are " +
               bounds_text(model.header());
    }
    if (const auto written = write_mesh(output_, extraction.mesh); !written)
    {
        return written.error().text;
    }
    const auto tell = [](const std::string& text)
    { log_message(LogLevel::info, "spm_inspect", text); };
    tell(fmt::format("{}: {} faces", output_, extraction.mesh.faces.size()));
    tell(fmt::format("error bound   {:.3g} m at most", extraction.error_max_m));
    if (request.zone)
    {
        tell(fmt::format("region        {} faces of the source", extraction.zone_faces));
    }
    return std::nullopt;
}

} // namespace tactus

namespace tactus::spm_inspect
{

namespace
{

void declare_options(CommandLine& line, Options& options)
{
    line.add_version("spm_inspect " TACTUS_VERSION);
    line.begin_task("Output", "spm_inspect ball.spm --distances points.txt");
    line.add_option("FILE", options.file, "Model to inspect (.spm)").required();
    line.add_flag("--json", options.json, "Print the output as one JSON object");
    const auto regions = line.add_flag("--regions", options.regions, "List the occupied regions");
    const auto records = line.add_flag(
        "--records", options.records,
        "List the records (vertex splits) with new vertex, parent vertex, depth and position");
    line.add_option("--distances", options.points,
                    "File of points whose distances from the surface are printed instead: lines x "
                    "y z in metres, in the source's frame; - is standard input")
        .excludes(regions)
        .excludes(records);
    options.extractor.declare_options(line);
    line.add_log_options();
}

/// Fault of a combination of options; empty if there is none.
std::string check_together(const Options& options)
{
    if (is_mesh_file_name(options.file))
    {
        return "FILE: " + mesh_is_no_model(options.file);
    }
    if (const auto reason = options.extractor.wrong_usage())
    {
        return *reason;
    }
    return !options.points.empty() && options.extractor.is_wanted()
               ? "--distances and --extract can't be combined"
               : "";
}

} // namespace

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

} // namespace tactus::spm_inspect
