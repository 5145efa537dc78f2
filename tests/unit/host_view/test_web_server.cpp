// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Server over real sockets, addressed byte by byte: a client library would correct the requests.

#include "host_tools/spm_view/web_server.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/host_view/live_rig.hpp"
#include "tests/unit/host_web/connection.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace tactus::view
{
namespace
{

using tactus::test::Connection;

struct WebServerTest : ::testing::Test
{
    void SetUp() override
    {
        const std::vector<std::string> files{tactus::test::small_model(0).path.string()};
        shelf_ = std::move(ModelShelf::open(files)).value();
        sut_ = std::move(WebServer::start({live_, *shelf_, 3, TACTUS_JAVASCRIPT_DIR}, 0)).value();
    }
    [[nodiscard]] std::string ask(const std::string& request) const
    {
        Connection connection(sut_->port());
        connection.send(request);
        return connection.read();
    }
    [[nodiscard]] std::string host() const { return fmt::format("127.0.0.1:{}", sut_->port()); }
    [[nodiscard]] std::string get(const std::string& path, const std::string& more = "") const
    {
        return ask(fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\n{}\r\n", path, host(), more));
    }
    static int status_of(const std::string& answer)
    {
        return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9, 3)) : 0;
    }

    LiveState live_;
    std::unique_ptr<ModelShelf> shelf_;
    std::unique_ptr<WebServer> sut_;
};

TEST_F(WebServerTest, serves_the_page_and_all_that_it_names)
{
    const std::string page = get("/");
    EXPECT_EQ(status_of(page), 200);
    EXPECT_NE(page.find("Content-Security-Policy: default-src 'self'"), std::string::npos);
    EXPECT_EQ(page.find("http://"), std::string::npos);
    EXPECT_EQ(page.find("https://"), std::string::npos);
    for (const char* path : {"/view.css", "/view.js", "/scene.js", "/plots.js", "/history.js",
                             "/player.js", "/lib/three.min.js", "/lib/OrbitControls.js",
                             "/lib/dygraph.min.js", "/lib/dygraph.min.css", "/state", "/metrics"})
    {
        EXPECT_EQ(status_of(get(path)), 200) << path;
    }
    for (const char* path : {"/nothing", "/lib/../main.cpp", "/../../etc/passwd", "/lib/"})
    {
        EXPECT_EQ(status_of(get(path)), 404) << path;
    }
}

TEST_F(WebServerTest, answers_only_get)
{
    for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "HEAD", "PATCH"})
    {
        const std::string answer = ask(fmt::format("{} /state HTTP/1.1\r\nHost: {}\r\n"
                                                   "Content-Length: 0\r\n\r\n",
                                                   method, host()));
        EXPECT_EQ(status_of(answer), 405) << method;
    }
}

TEST_F(WebServerTest, answers_only_to_its_own_name)
{
    const auto status = [&](const std::string& lines)
    { return status_of(ask("GET /state HTTP/1.1\r\n" + lines + "\r\n")); };
    EXPECT_EQ(status(fmt::format("Host: localhost:{}\r\n", sut_->port())), 200);
    for (const std::string& wrong :
         {std::string("evil.example"), std::string("127.0.0.1"), host() + ".evil.example",
          std::string("127.0.0.1:1"), std::string()})
    {
        EXPECT_EQ(status("Host: " + wrong + "\r\n"), 421) << wrong;
    }
    EXPECT_EQ(status(""), 421);
    EXPECT_EQ(status("Host: " + host() + "\r\nHost: evil.example\r\n"), 421);
}

TEST_F(WebServerTest, answers_no_page_of_others)
{
    EXPECT_EQ(status_of(get("/state", "Origin: http://" + host() + "\r\n")), 200);
    for (const std::string& wrong :
         {std::string("http://evil.example"), std::string("null"), "https://" + host(), host()})
    {
        EXPECT_EQ(status_of(get("/state", "Origin: " + wrong + "\r\n")), 403) << wrong;
    }
}

TEST_F(WebServerTest, survives_requests_that_are_none)
{
    for (const std::string& broken :
         {std::string("\r\n\r\n"), std::string("GET\r\n\r\n"), std::string("GET / HTTP/9\r\n\r\n"),
          std::string(100'000, 'a'), "GET /" + std::string(20'000, 'a') + " HTTP/1.1\r\n\r\n",
          std::string("\0\xFF\r\n\r\n", 6), std::string("GET /state HTTP/1.1\r\nHost"),
          "GET /front?serial=1&model=zz HTTP/1.1\r\nHost: " + host() + "\r\n\r\n"})
    {
        Connection connection(sut_->port());
        connection.send(broken);
        connection.end_sending();
        EXPECT_NE(status_of(connection.read()), 200);
    }
    EXPECT_EQ(status_of(get("/state")), 200);
}

TEST_F(WebServerTest, sends_no_parts_however_many_are_asked_for)
{
    const std::string whole = get("/lib/three.min.js");
    std::string ranges = "Range: bytes=0-";
    for (int i = 0; i < 300; ++i)
    {
        ranges += ",0-";
    }
    for (const std::string& range :
         {ranges, std::string("Range: bytes=0-9"), ranges + "\r\n" + ranges})
    {
        EXPECT_EQ(get("/lib/three.min.js", range + "\r\n"), whole);
    }
}

TEST_F(WebServerTest, answers_one_that_asks_while_forty_keep_silent)
{
    tactus::test::expect_answer_among_silent(sut_->port(), 40,
                                             [this] { return status_of(get("/state")); });
}

TEST_F(WebServerTest, gives_up_a_request_that_comes_byte_by_byte)
{
    Connection connection(sut_->port());
    connection.send("GET /");
    std::size_t bytes = 0;
    for (; bytes < 8'000 && !connection.is_closed(); ++bytes) // Longer requests are refused.
    {
        connection.send("a");
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_LT(bytes, 8'000U);
    EXPECT_EQ(status_of(get("/state")), 200);
}

TEST_F(WebServerTest, gives_up_a_request_without_end)
{
    Connection connection(sut_->port());
    connection.send("GET /state HTTP/1.1\r\n");
    std::string lines;
    for (int i = 0; i < 100; ++i)
    {
        lines += fmt::format("X-{}: {}\r\n", i, std::string(100, 'x'));
    }
    std::size_t kilobytes = 0;
    for (; kilobytes < 100'000 && !connection.is_closed(); kilobytes += 11)
    {
        connection.send(lines);
    }
    EXPECT_LT(kilobytes, 100'000U);
    EXPECT_EQ(status_of(get("/state")), 200);
}

TEST_F(WebServerTest, lets_four_viewers_watch_and_goes_on_answering)
{
    const std::string request = fmt::format("GET /events HTTP/1.1\r\nHost: {}\r\n\r\n", host());
    std::vector<std::unique_ptr<Connection>> viewers;
    for (std::size_t i = 0; i < WebServer::kViewersMax; ++i)
    {
        viewers.push_back(std::make_unique<Connection>(sut_->port()));
        viewers.back()->send(request);
        EXPECT_NE(viewers.back()->read("no news").find("text/event-stream"), std::string::npos);
    }
    EXPECT_EQ(status_of(ask(request)), 503);
    EXPECT_EQ(status_of(get("/state")), 200);
    std::atomic<bool> is_over{false};
    std::thread hears(
        [&]
        {
            while (!is_over.load())
            {
                live_.publish({test::told(1, "one")});
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
        });
    for (const auto& viewer : viewers)
    {
        EXPECT_NE(viewer->read("\"one\"").find("data: {"), std::string::npos);
    }
    viewers.pop_back(); // The viewer's thread is free after that is detected.
    std::string again;
    while (again.find("data: {") == std::string::npos)
    {
        Connection next(sut_->port());
        next.send(request);
        again = next.read("data: {"); // Reads to the end of a refusal otherwise.
    }
    is_over.store(true);
    hears.join();
}

TEST_F(WebServerTest, feeds_the_chosen_controller_and_lets_a_slow_reader_skip)
{
    const auto feed = [&](const std::string& query)
    {
        auto connection = std::make_unique<Connection>(sut_->port());
        connection->send(fmt::format("GET /feed{} HTTP/1.1\r\nHost: {}\r\n\r\n", query, host()));
        return connection;
    };
    const auto slow = feed(""); // It reads at the end only.
    const auto two = feed("?controller=two");
    const auto absent = feed("?controller=three");
    dds::WatchedController one = test::told(1, "one");
    dds::WatchedController other = test::told(2, "two");
    for (std::uint64_t serial = 1; serial <= 20'000; ++serial)
    {
        one.serial = other.serial = serial;
        live_.publish({one, other});
    }
    const std::string read = two->read("\"serial\":20000,");
    EXPECT_NE(read.find("\"name\":\"two\""), std::string::npos);
    EXPECT_EQ(read.find("\"name\":\"one\""), std::string::npos);
    EXPECT_NE(slow->read("\"serial\":20000,").find("data: {"), std::string::npos);
    EXPECT_EQ(absent->read("no news").find("data: {"), std::string::npos);
}

TEST_F(WebServerTest, serves_pages_of_the_user_from_one_folder_only)
{
    const auto folder = tactus::test::small_model(0).path.parent_path();
    const std::string file = tactus::test::small_model(0).path.filename().string();
    EXPECT_EQ(status_of(get("/pages/" + file)), 404) << "without a folder";
    sut_.reset();
    WebServer::Parts parts{live_, *shelf_, 3, TACTUS_JAVASCRIPT_DIR};
    parts.pages = folder;
    sut_ = std::move(WebServer::start(parts, 0)).value();
    EXPECT_EQ(status_of(get("/pages/" + file)), 200);
    for (const char* path : {"/pages/../../../etc/passwd", "/pages/%2e%2e/%2e%2e/etc/passwd",
                             "/pages/nothing", "/pages//etc/passwd"})
    {
        EXPECT_EQ(status_of(get(path)), 404) << path;
    }
    parts.pages = folder / file;
    const auto refused = WebServer::start(parts, 0);
    ASSERT_FALSE(refused);
    EXPECT_TRUE(refused.error().text.starts_with("--pages: '")) << refused.error().text;
}

TEST_F(WebServerTest, sends_the_faces_of_a_front)
{
    const ContentHash hash = shelf_->labels().front().hash;
    RefinementState seen = test::state();
    seen.models.push_back({hash, {}, {}});
    live_.publish({test::told(1, "one", 9, seen)});
    const std::string controller = id_text(test::told(1, "one").id);
    const auto status =
        [&](const std::string& id, const std::string& serial, const std::string& model)
    {
        return status_of(
            get(fmt::format("/front?controller={}&serial={}&model={}", id, serial, model)));
    };
    EXPECT_EQ(status(controller, "9", hash_text(hash)), 200);
    EXPECT_EQ(status(controller, "8", hash_text(hash)), 404);
    EXPECT_EQ(status("another", "9", hash_text(hash)), 404);
    EXPECT_EQ(status(controller, "9", std::string(32, '0')), 404);
    EXPECT_EQ(status(controller, "-9", hash_text(hash)), 400);
    EXPECT_EQ(status(controller, "9x", hash_text(hash)), 400);
    seen.models[0].pages = {{{0xFFFFU}, 1}}; // Chunk that the model does not have.
    live_.publish({test::told(1, "one", 10, seen)});
    EXPECT_EQ(status(controller, "10", hash_text(hash)), 409);
}

TEST_F(WebServerTest, sends_what_can_be_split_of_a_front_that_leaves_pages_out)
{
    const ContentHash hash = shelf_->labels().front().hash;
    const ChunkId last{shelf_->find(hash)->header().counts().chunks() - 1};
    RefinementState seen = test::state();
    seen.models.push_back({hash, {{last, 1}}, {}}); // The chunk's records depend on others.
    std::uint64_t serial = 9;
    const auto status = [&](const char* path)
    {
        return status_of(
            get(fmt::format("{}?controller={}&serial={}&model={}", path,
                            id_text(test::told(1, "one").id), serial, hash_text(hash))));
    };
    live_.publish({test::told(1, "one", serial, seen)});
    EXPECT_EQ(status("/front"), 409);
    EXPECT_EQ(status("/boxes"), 409);
    ++serial;
    seen.slots_left_out = 1;
    live_.publish({test::told(1, "one", serial, seen)});
    EXPECT_EQ(status("/front"), 200);
    EXPECT_EQ(status("/boxes"), 200);
}

TEST_F(WebServerTest, sends_the_boxes_of_what_is_requested)
{
    const ContentHash hash = shelf_->labels().front().hash;
    RefinementState seen = test::state();
    seen.models.push_back({hash, {}, {}});
    std::uint64_t serial = 9;
    const auto boxes = [&]
    {
        const dds::WatchedController one = test::told(1, "one", ++serial, seen);
        live_.publish({one});
        return get(fmt::format("/requested?controller={}&serial={}&model={}", id_text(one.id),
                               serial, hash_text(hash)));
    };
    const std::string none = boxes();
    EXPECT_EQ(status_of(none), 200);
    seen.models.back().requested = {{0}};
    const std::string one = boxes(); // The same cut: by that alone they would be the old ones.
    EXPECT_EQ(status_of(one), 200);
    EXPECT_EQ(one.size(), none.size() + 6 * sizeof(float) + 1); // 28 for 4 in the head.
    seen.models.back().requested = {{0xFFFFU}};
    EXPECT_EQ(status_of(boxes()), 409);
}

TEST_F(WebServerTest, refuses_a_port_that_another_has)
{
    const auto second = WebServer::start({live_, *shelf_, 3, TACTUS_JAVASCRIPT_DIR}, sut_->port());
    ASSERT_FALSE(second.has_value());
    EXPECT_NE(second.error().text.find(std::to_string(sut_->port())), std::string::npos);
    const auto without = WebServer::start({live_, *shelf_, 3, "/nonexistent"}, 0);
    ASSERT_FALSE(without.has_value());
    EXPECT_NE(without.error().text.find("three.min.js"), std::string::npos);
}

} // namespace
} // namespace tactus::view
