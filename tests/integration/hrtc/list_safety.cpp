// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// list_safety REPORT: prints the events of tool 0 in a report's `safety`, one a line: TIME_S FRAME
/// STATE CAUSES. FRAME is "-" for an event of the supervisor; CAUSES are joined by commas, "-" for
/// none. Exits 2 if the report cannot be read.

#include <nlohmann/json.hpp>

#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

namespace
{

using Json = nlohmann::json;

std::string line_of(const Json& event)
{
    std::string causes;
    for (const Json& cause : event.at("causes"))
    {
        causes += (causes.empty() ? "" : ",") + cause.get<std::string>();
    }
    const Json& frame = event.at("frame");
    return event.at("time_s").dump() + ' ' + (frame.is_null() ? "-" : frame.dump()) + ' ' +
           event.at("state").get<std::string>() + ' ' + (causes.empty() ? "-" : causes);
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::fprintf(stderr, "usage: list_safety REPORT\n");
        return 2;
    }
    try
    {
        std::ifstream file(argv[1]);
        const Json report = Json::parse(file);
        for (const Json& event : report.at("safety").at("events"))
        {
            if (event.at("tool") == 0)
            {
                std::puts(line_of(event).c_str());
            }
        }
        return 0;
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
    }
    return 2;
}
