// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A publisher and many clients on loopback: throughput and number of clients.

#include "tests/bench/published.hpp"
#include "tests/bench/stream_cases.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace tactus::bench
{

namespace
{

using Json = nlohmann::json;

std::string client_name(std::uint32_t number)
{
    return fmt::format("client-{}", number);
}

Program start_client(const std::filesystem::path& folder, std::uint32_t number, double rate_hz,
                     double seconds)
{
    std::filesystem::create_directory(folder / client_name(number));
    return start_at({}, "stream_client", folder / client_name(number),
                    {"--model", "model", "--name", client_name(number), "--rate",
                     fmt::format("{}", rate_hz), "--seconds", fmt::format("{}", seconds)});
}

Json client_report(Program& client, const std::filesystem::path& folder, std::uint32_t number)
{
    client.wait();
    return report_in(folder / client_name(number) / "stream_client.log");
}

double resident_mib(pid_t id)
{
    std::ifstream file(fmt::format("/proc/{}/status", id));
    for (std::string word; file >> word;)
    {
        if (word == "VmRSS:")
        {
            double kib = 0.0;
            file >> kib;
            return kib / 1'024.0;
        }
    }
    return 0.0;
}

} // namespace

void run_throughput_case(const CaseContext& context, const ThroughputCase& test_case)
{
    constexpr double kSeconds = 5.0;
    const Scene& scene = context.scenes.get(test_case.scene);
    const test::TemporaryFolder folder("throughput");
    const auto server = publish(scene, {}, folder.path());
    const double before_mib = resident_mib(server.id());
    auto client = start_client(folder.path(), 0, 0.0, kSeconds);
    const auto report = client_report(client, folder.path(), 0);
    CaseRows rows(context.rows, context.common_row(scene.model.name, "throughput"));
    const double seconds = report["seconds"].get<double>();
    rows.add("samples", report["link_bytes"].get<double>() * 1e-6 / seconds, "MB/s",
             test_case.mb_per_s)
        .is_least = true;
    rows.add("pieces", report["pieces"].get<double>() / seconds, "/s");
    rows.add("server before", before_mib, "MiB");
    rows.add("server after", resident_mib(server.id()), "MiB");
}

void run_fan_out_case(const CaseContext& context, const FanOutCase& test_case)
{
    constexpr double kSeconds = 10.0;
    constexpr double kServedGoal = 95.0; // The last chunks are in transit at the end.
    const Scene& scene = context.scenes.get(test_case.scene);
    const test::TemporaryFolder folder("fan-out");
    const auto server = publish(scene, {}, folder.path());
    CaseRows rows(context.rows, context.common_row(scene.model.name, "many controllers"));
    rows.add("clients", test_case.clients, "");
    double before_ms = 0.0;
    for (const bool stops_one : {false, true})
    {
        if (stops_one && !test_case.stops_one)
        {
            break;
        }
        std::vector<Program> clients;
        for (std::uint32_t i = 0; i < test_case.clients; ++i)
        {
            clients.push_back(start_client(folder.path(), i, test_case.rate_hz, kSeconds));
        }
        for (const Program& client : clients)
        {
            client.wait_for("connected", kStartTimeout);
        }
        if (stops_one)
        {
            clients[0].send_signal(SIGSTOP);
        }
        double p99_ms = 0.0;
        double least_share = 1.0;
        for (std::uint32_t i = stops_one ? 1 : 0; i < test_case.clients; ++i)
        {
            const auto report = client_report(clients[i], folder.path(), i);
            p99_ms = std::max(p99_ms, report["p99_ms"].get<double>());
            least_share = std::min(least_share,
                                   report["pieces"].get<double>() / (test_case.rate_hz * kSeconds));
        }
        const char* when = stops_one ? "one stopped: " : "";
        rows.add(fmt::format("{}worst p99", when), p99_ms, "ms", goal_if(test_case.p99_ms));
        rows.add(fmt::format("{}least served", when), 100.0 * least_share, "%", kServedGoal)
            .is_least = true;
        if (stops_one)
        {
            rows.add("worst p99 above before", 100.0 * (p99_ms / before_ms - 1.0), "%", 10.0);
        }
        before_ms = p99_ms;
    }
    rows.add("server", resident_mib(server.id()), "MiB");
}

} // namespace tactus::bench
