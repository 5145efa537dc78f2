// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/scenes.hpp"
#include "transport/dds/dds_host.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

namespace tactus::bench
{

/// Model server in its own thread, which shows objects and moves some of them 100 times a second.
class ShowingHost
{
public:
    /// Serves these files as "model-0" and so on; the objects in the scene "bench" show them in
    /// turn.
    [[nodiscard]] static std::unique_ptr<ShowingHost>
    start(std::uint32_t domain, const std::vector<std::filesystem::path>& files,
          std::uint32_t objects);
    ~ShowingHost();
    ShowingHost(const ShowingHost&) = delete;
    ShowingHost& operator=(const ShowingHost&) = delete;

    /// Number of objects that move from now on, the first ones.
    void move(std::uint32_t objects) { moving_ = objects; }

private:
    explicit ShowingHost(std::unique_ptr<dds::DdsHost> host) : host_(std::move(host)) {}
    void run();

    std::unique_ptr<dds::DdsHost> host_;
    std::atomic<std::uint32_t> moving_{0};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace tactus::bench
