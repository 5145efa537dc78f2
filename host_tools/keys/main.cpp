// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/site.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "transport/dds/key_folder.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <variant>

namespace tactus::keys
{

namespace
{

int run(int argc, char** argv)
{
    CommandLine line("tactus-keys", "Makes the keys of the programs on a DDS domain: certificates, "
                                    "their rights, and an archive for each machine.");
    auto parsed = parse_options(line, argc, argv);
    if (const int* code = std::get_if<int>(&parsed))
    {
        return *code;
    }
    const auto made = make_keys(std::get<Site>(parsed), std::time(nullptr));
    if (!made)
    {
        return line.fail(made.error().text);
    }
    for (const IssuedKeys& keys : made.value())
    {
        fmt::print("{:<10} {:<16} cert:{} until {:%Y-%m-%d}{} {}\n", name_of(keys.member.role),
                   keys.member.name, dds::certificate_digits(keys.member.name),
                   fmt::gmtime(keys.until), keys.is_new ? ", new:" : ":", keys.archive);
    }
    return kExitDone;
}

} // namespace

} // namespace tactus::keys

int main(int argc, char** argv)
{
    return tactus::run_program("tactus-keys", "", [&] { return tactus::keys::run(argc, argv); });
}
