// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/options.hpp"

#include "platform/program/command_line.hpp"
#include "transport/base/printable.hpp"
#include "transport/dds/domain.hpp"

#include <fmt/format.h>

namespace tactus::view
{

namespace
{

void declare_options(CommandLine& line, Options& options)
{
    line.add_version("spm_view " TACTUS_VERSION);
    line.begin_task("Watch controllers", "spm_view bunny.spm --domain 3");
    line.add_option("FILE", options.files,
                    "Files of models that controllers touch (.spm), found by their hashes. Other "
                    "models are fetched from their servers, as far as controllers refine them");
    const auto domain = line.add_option("--domain", options.domain, "DDS domain")
                            .integer_between(std::uint32_t{0}, dds::kMaxDomain)
                            .show_default();
    line.add_security_options(options.security);
    line.add_option_file("--config", "TOML file with options; the command line overrides the file");
    line.begin_task("Play a recording, or compare two",
                    "spm_view --replay run.rec --replay again.rec");
    line.add_option("--replay", options.recordings,
                    "Recording of hrtc --record to show instead of live controllers; a second one "
                    "is compared with the first. Needs no model file")
        .repeatable()
        .excludes(domain);
    line.begin_task("Serve the page", "spm_view --port 8080 --seconds 3600");
    line.add_option("--port", options.port, "Port of 127.0.0.1; 0 selects a free port")
        .integer_between(std::uint32_t{0}, std::uint32_t{65'535})
        .show_default();
    line.add_option("--seconds", options.seconds,
                    "Duration of the run, in seconds [default: no limit]")
        .number_between(0.1, 1e9);
    line.add_log_options();
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
    if (options.recordings.size() > 2)
    {
        return line.fail(fmt::format("--replay: {} recordings; at most 2 can be compared",
                                     options.recordings.size()),
                         kExitUsage);
    }
    for (const std::string& file : options.files)
    {
        if (file.ends_with(".rec"))
        {
            return line.fail(fmt::format("FILE: '{0}' is a recording; show it with --replay {0}",
                                         printable(file)),
                             kExitUsage);
        }
    }
    return options;
}

} // namespace tactus::view
