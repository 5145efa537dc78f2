// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/web/metrics_server.hpp"
#include "host_tools/web/prometheus_text.hpp"
#include "tests/unit/host_web/connection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

namespace tactus::web
{
namespace
{

TEST(PrometheusText, lays_out_families_and_samples)
{
    PrometheusText sut;
    EXPECT_EQ(sut.text(), "");
    sut.family("a_total", "counter", "What it counts.");
    sut.sample({}, 3.0);
    sut.family("b", "gauge", "What it shows.");
    sut.sample({{"one", "x"}, {"two", "y"}}, -0.5);
    EXPECT_EQ(sut.text(), "# HELP a_total What it counts.\n# TYPE a_total counter\na_total 3\n"
                          "# HELP b What it shows.\n# TYPE b gauge\nb{one=\"x\",two=\"y\"} -0.5\n");
}

TEST(PrometheusText, escapes_the_values_of_labels)
{
    PrometheusText sut;
    sut.family("a", "gauge", "A.");
    sut.sample({{"name", "a\"b\\c\nd"}}, 0.25);
    EXPECT_NE(sut.text().find("a{name=\"a\\\"b\\\\c\\nd\"} 0.25\n"), std::string::npos)
        << sut.text();
}

TEST(PrometheusText, tells_of_controllers)
{
    dds::WatchedController controller;
    controller.name = "hand-1";
    controller.id.fill(0xAB);
    controller.telemetry.frame = 1'234;
    controller.telemetry.exact = 1'000;
    controller.telemetry.missed = 5;
    controller.telemetry.tool_count = 2;
    controller.telemetry.tools[0].force_n = {1.0, 2.0, 2.0};
    controller.telemetry.tools[1].in_contact = true;
    controller.telemetry.tools[2].force_n = {100.0, 0.0, 0.0}; // This tool does not exist.
    PrometheusText sut;
    tell_controllers(sut, {&controller});
    const std::string labels = "{controller=\"hand-1\",id=\"abababababababababababababababab\"} ";
    for (const std::string& line :
         {std::string("tactus_controllers 1"), "tactus_frames_total" + labels + "1234",
          "tactus_frames_exact_total" + labels + "1000",
          "tactus_deadlines_missed_total" + labels + "5", "tactus_force_newtons" + labels + "3",
          "tactus_tools_in_contact" + labels + "1"})
    {
        EXPECT_NE(sut.text().find("\n" + line + "\n"), std::string::npos) << line << "\nin\n"
                                                                          << sut.text();
    }
}

/// Prometheus refuses a text that describes a name twice.
TEST(PrometheusText, tells_of_each_name_once)
{
    PrometheusText sut;
    tell_controllers(sut, {});
    std::istringstream lines(sut.text());
    std::vector<std::string> types;
    for (std::string line; std::getline(lines, line);)
    {
        if (line.starts_with("# TYPE "))
        {
            types.push_back(line);
        }
    }
    EXPECT_EQ(types.size(), 12U);
    std::ranges::sort(types);
    EXPECT_EQ(std::ranges::adjacent_find(types), types.end());
}

TEST(MetricsServer, does_not_share_a_port)
{
    const auto first = MetricsServer::start(0, "--metrics");
    ASSERT_TRUE(first) << first.error().text;
    const auto second = MetricsServer::start(first.value()->port(), "--metrics");
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().text.find("is not available"), std::string::npos)
        << second.error().text;
    EXPECT_NE(second.error().text.find("--metrics"), std::string::npos) << second.error().text;
}

TEST(MetricsServer, answers_one_that_asks_while_28_keep_silent)
{
    const auto sut = MetricsServer::start(0, "--metrics");
    ASSERT_TRUE(sut);
    MetricsServer& server = *sut.value();
    server.publish("alarm 1\n");
    const auto ask = [&server]
    {
        test::Connection connection(server.port());
        connection.send("GET /metrics HTTP/1.1\r\nHost: localhost:" +
                        std::to_string(server.port()) + "\r\n\r\n");
        const std::string answer = connection.read();
        EXPECT_TRUE(answer.ends_with("\r\n\r\nalarm 1\n")) << answer;
        return answer.starts_with("HTTP/1.1 200 ") ? 200 : 0;
    };
    EXPECT_EQ(ask(), 200);
    test::expect_answer_among_silent(server.port(), 28, ask);
}

} // namespace
} // namespace tactus::web
