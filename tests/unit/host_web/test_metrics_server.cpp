// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/web/metrics_server.hpp"
#include "tests/unit/host_web/connection.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus::web
{

namespace
{

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
