// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/scenes.hpp"
#include "transport/dds/dds_server.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

namespace tactus::bench
{

/// Model server in its own thread, which shows objects and moves some of them 100 times a second.
class ShowingServer
{
public:
    /// Serves these files as "model-0" and so on; the objects in the scene "bench" show them in
    /// turn.
    [[nodiscard]] static std::unique_ptr<ShowingServer>
    start(std::uint32_t domain, const std::vector<std::filesystem::path>& files,
          std::uint32_t objects);
    ~ShowingServer();
    ShowingServer(const ShowingServer&) = delete;
    ShowingServer& operator=(const ShowingServer&) = delete;

    /// Number of objects that move from now on, the first ones.
    void move(std::uint32_t objects) { moving_ = objects; }

private:
    explicit ShowingServer(std::unique_ptr<dds::DdsServer> server) : server_(std::move(server)) {}
    void run();

    std::unique_ptr<dds::DdsServer> server_;
    std::atomic<std::uint32_t> moving_{0};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace tactus::bench
