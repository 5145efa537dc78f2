// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/network_security.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tactus
{
class CommandLine;
} // namespace tactus

namespace tactus::view
{

/// IPv4 address and port; 127.0.0.1 is 0x7F000001.
struct FeedAddress
{
    std::uint32_t address{0x7F00'0001U};
    std::uint16_t port{0};
};

/// Options of the command line; checked, in SI units.
struct Options
{
    std::vector<std::string> files;
    std::vector<std::string> recordings; ///< At most two recordings; none: live data are shown.
    std::uint32_t port{7'300};
    std::uint32_t domain{0};
    NetworkSecurity security;
    std::optional<double> seconds;
    std::string pages;                   ///< Folder of the user's pages; empty: none.
    std::optional<FeedAddress> feed_udp; ///< Receiver of the feed's datagrams.
};

/// Reads the command line. Returns the exit code instead if the program should leave: after --help,
/// --version, or wrong usage, which gets one line on stderr.
[[nodiscard]] std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv);

} // namespace tactus::view
