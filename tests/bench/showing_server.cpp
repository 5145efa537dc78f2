// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/showing_server.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace tactus::bench
{

namespace
{

constexpr std::chrono::milliseconds kMoveEvery{10};
constexpr double kStep_m = 0.001; ///< 0.1 m/s.

/// Grid position.
Pose place_of(std::uint32_t object)
{
    Pose pose;
    pose.translation_m = {0.2 * (object % 16), 0.2 * (object / 16 % 16), 0.2 * (object / 256)};
    return pose;
}

} // namespace

std::unique_ptr<ShowingServer> ShowingServer::start(std::uint32_t domain,
                                                    const std::vector<std::filesystem::path>& files,
                                                    std::uint32_t objects)
{
    std::vector<dds::PublishedModel> models;
    for (const std::filesystem::path& file : files)
    {
        auto store = needed(ModelStore::open(file));
        models.push_back({fmt::format("model-{}", models.size()), std::move(store)});
    }
    auto made = needed(dds::DdsServer::create(domain, std::move(models), {}, "bench"));
    std::unique_ptr<ShowingServer> showing(new ShowingServer(std::move(made)));
    dds::DdsServer& server = *showing->server_;
    for (std::uint32_t i = 0; i < objects; ++i)
    {
        ShownObject object;
        object.name = fmt::format("object-{}", i);
        object.model = server.models()[i % server.models().size()].store().hash();
        object.pose = place_of(i);
        needed(server.objects().show(object));
    }
    showing->thread_ = std::thread([&self = *showing] { self.run(); });
    return showing;
}

ShowingServer::~ShowingServer()
{
    stop_ = true;
    if (thread_.joinable())
    {
        thread_.join();
    }
}

void ShowingServer::run()
{
    using Clock = std::chrono::steady_clock;
    auto due = Clock::now();
    std::uint32_t steps = 0;
    while (!stop_)
    {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(due - Clock::now());
        server_->wait(std::max(left, std::chrono::milliseconds(0)));
        if (Clock::now() >= due)
        {
            due += kMoveEvery;
            ++steps;
            const std::uint32_t moving = moving_;
            for (std::uint32_t i = 0; i < moving; ++i)
            {
                Pose pose = place_of(i);
                pose.translation_m[2] += kStep_m * (steps % 100);
                static_cast<void>(server_->objects().move(i, pose));
            }
        }
        server_->step();
    }
}

} // namespace tactus::bench
