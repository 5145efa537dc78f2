// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/bench_row.hpp"

#include "platform/hrtc/machine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tactus::bench
{

std::string to_table(const Rows& rows)
{
    std::string text;
    std::string heading;
    for (const Row& row : rows)
    {
        const std::string now = fmt::format("{} / {}", row.scene, row.test_case);
        if (now != heading)
        {
            heading = now;
            text += fmt::format("{}  ({} frames, seed {}, hash {:016x})\n", now, row.frames,
                                row.seed, row.hash);
        }
        text += fmt::format("  {:<24}{:>12.3f} {:<8}", row.metric, row.value, row.unit);
        if (row.peer)
        {
            text += fmt::format("{} {:.3f}", *row.peer, row.peer_value);
        }
        while (text.back() == ' ')
        {
            text.pop_back();
        }
        text += '\n';
    }
    return text;
}

std::string to_json(const Rows& rows)
{
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const Row& row : rows)
    {
        Json entry{{"suite", row.suite},
                   {"case", row.test_case},
                   {"metric", row.metric},
                   {"value", row.value},
                   {"unit", row.unit}};
        if (row.peer)
        {
            entry["peer"] = *row.peer;
            entry["peer_value"] = row.peer_value;
        }
        entry["scene"] = row.scene;
        entry["seed"] = row.seed;
        entry["frames"] = row.frames;
        entry["hash"] = fmt::format("{:016x}", row.hash);
        list.push_back(entry);
    }
    const hrtc::Machine machine = hrtc::describe_machine();
    const Json all{{"schema", 1},
                   {"commit", TACTUS_COMMIT},
                   {"machine",
                    {{"kernel", machine.kernel},
                     {"preemption", machine.preemption},
                     {"processor", machine.processor},
                     {"processors", machine.processors},
                     {"load_average", machine.load_average},
                     {"date_utc", machine.date_utc}}},
                   {"compiler", __VERSION__},
                   {"rows", list}};
    return all.dump(2) + "\n";
}

} // namespace tactus::bench
