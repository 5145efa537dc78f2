// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/options.hpp"

#include "platform/program/command_line.hpp"
#include "transport/base/printable.hpp"
#include "transport/dds/domain.hpp"

#include <fmt/format.h>

#include <arpa/inet.h>
#include <charconv>
#include <netinet/in.h>
#include <system_error>

namespace tactus::view
{

namespace
{

/// Address in the form PORT or ADDRESS:PORT; none if the text has another form.
std::optional<FeedAddress> feed_address_of(const std::string& text)
{
    FeedAddress result;
    const std::size_t colon = text.find(':');
    if (colon != std::string::npos)
    {
        in_addr address{};
        if (inet_pton(AF_INET, text.substr(0, colon).c_str(), &address) != 1)
        {
            return std::nullopt;
        }
        result.address = ntohl(address.s_addr);
    }
    const char* const begin = text.c_str() + (colon == std::string::npos ? 0 : colon + 1);
    const char* const end = text.c_str() + text.size();
    const auto [read, error] = std::from_chars(begin, end, result.port);
    return error == std::errc{} && read == end && result.port > 0 ? std::optional(result)
                                                                  : std::nullopt;
}

/// Reason why the feed can't go to this address; empty if it can.
std::string fault_of_feed(const std::string& text, Options& options)
{
    options.feed_udp = feed_address_of(text);
    if (!options.feed_udp)
    {
        return fmt::format("--feed-udp: '{}' is not PORT or ADDRESS:PORT with a numeric IPv4 "
                           "address and a port of 1 to 65535",
                           printable(text));
    }
    const bool is_loopback = options.feed_udp->address >> 24U == 127U;
    return is_loopback || options.security.is_plain
               ? ""
               : fmt::format("--feed-udp: '{}' is not on this machine, and the feed has no keys; "
                             "to send it all the same, use --plain",
                             printable(text));
}

void declare_options(CommandLine& line, Options& options, std::string& feed_udp)
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
    const auto replay =
        line.add_option("--replay", options.recordings,
                        "Recording of hrtc --record to show instead of live controllers; a second "
                        "one is compared with the first. Needs no model file")
            .repeatable()
            .excludes(domain);
    line.begin_task("Serve the page", "spm_view --port 8080 --seconds 3600");
    line.add_option("--port", options.port, "Port of 127.0.0.1; 0 selects a free port")
        .integer_between(std::uint32_t{0}, std::uint32_t{65'535})
        .show_default();
    line.begin_task("Feed a graphics program", "spm_view --pages web --feed-udp 7301");
    line.add_option("--pages", options.pages,
                    "Folder of web pages to serve at /pages/; they read poses and forces at /feed");
    line.add_option("--feed-udp", feed_udp,
                    "PORT or ADDRESS:PORT to send poses and forces to, in datagrams. Without "
                    "ADDRESS to 127.0.0.1; other machines need --plain")
        .excludes(replay);
    line.add_option("--seconds", options.seconds,
                    "Duration of the run, in seconds [default: no limit]")
        .number_between(0.1, 1e9);
    line.add_log_options();
}

} // namespace

std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv)
{
    Options options;
    std::string feed_udp;
    declare_options(line, options, feed_udp);
    if (const auto code = line.parse(argc, argv))
    {
        return *code;
    }
    if (const std::string fault = feed_udp.empty() ? "" : fault_of_feed(feed_udp, options);
        !fault.empty())
    {
        return line.fail(fault, kExitUsage);
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
