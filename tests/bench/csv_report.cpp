// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Rows as a table for other programs.

#include "platform/hrtc/machine.hpp"
#include "tests/bench/bench_report.hpp"

#include <fmt/format.h>

namespace tactus::bench
{

namespace
{

constexpr const char* kHead = "suite,part,case,by,setting,metric,value,unit,goal,met,peer,"
                              "peer_value,scene,seed,frames,hash,commit,processor,compiler\r\n";

/// In quotes when it would not be one field otherwise.
std::string field(const std::string& text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos)
    {
        return text;
    }
    std::string quoted = "\"";
    for (const char c : text)
    {
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    }
    return quoted + '"';
}

/// As many digits as give the same number again.
std::string field(double value)
{
    return fmt::format("{}", value);
}

} // namespace

std::string to_csv(const Rows& rows)
{
    const std::string tail =
        fmt::format(",{},{},{}\r\n", field(std::string(TACTUS_COMMIT)),
                    field(hrtc::describe_machine().processor), field(std::string(__VERSION__)));
    std::string text = kHead;
    for (const Row& row : rows)
    {
        text += fmt::format("{},{},{},{},{},{},{},{},", field(row.suite), field(row.part),
                            field(row.test_case), field(row.by), field(row.setting),
                            field(row.metric), field(row.value), field(row.unit));
        text += row.goal ? fmt::format("{},{},", field(*row.goal), row.is_met()) : ",,";
        text += row.peer ? fmt::format("{},{},", field(*row.peer), field(row.peer_value)) : ",,";
        text += fmt::format("{},{},{},{:016x}", field(row.scene), row.seed, row.frames, row.hash);
        text += tail;
    }
    return text;
}

} // namespace tactus::bench
