// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_inspect/options.hpp"

#include "host_tools/mesh/read_mesh.hpp"
#include "platform/program/command_line.hpp"

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
    if (const auto code = line.parse(argc, argv))
    {
        return *code;
    }
    if (const std::string fault = check_together(options); !fault.empty())
    {
        return line.fail(fault, kExitUsage);
    }
    return options;
}

} // namespace tactus::spm_inspect
