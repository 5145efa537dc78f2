// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace tactus::dds
{

/// Owns one entity of Cyclone DDS and deletes it, with all entities created below it.
class Entity
{
public:
    Entity() = default;
    explicit Entity(std::int32_t handle) noexcept : handle_(handle) {}
    Entity(Entity&& other) noexcept;
    Entity& operator=(Entity&& other) noexcept;
    Entity(const Entity&) = delete;
    Entity& operator=(const Entity&) = delete;
    ~Entity();

    /// Handle of Cyclone's C API; a negative value is an error code.
    [[nodiscard]] std::int32_t get() const noexcept { return handle_; }
    [[nodiscard]] bool is_valid() const noexcept { return handle_ > 0; }

private:
    std::int32_t handle_{0};
};

/// A reader or writer, and the subscriber or publisher of its own that defines its partition.
struct Endpoint
{
    Entity parent;
    std::int32_t handle{0};

    [[nodiscard]] bool is_valid() const noexcept { return parent.is_valid() && handle > 0; }
};

/// Deletes entities of Cyclone DDS on a thread of its own, which starts with the first dispose().
/// Deleting a writer takes about 10 ms, which would delay a server's other controllers.
class Disposal
{
public:
    Disposal() = default;
    /// Waits until all entities are deleted.
    ~Disposal();
    Disposal(const Disposal&) = delete;
    Disposal& operator=(const Disposal&) = delete;

    /// Queues `owner` for deletion; it must be the only owner. Null has no effect. Never waits for
    /// the deletion; any thread.
    void dispose(std::shared_ptr<void> owner);

private:
    void run();

    std::mutex mutex_;
    std::condition_variable has_news_;
    std::vector<std::shared_ptr<void>> waiting_;
    bool is_over_{false};
    std::thread thread_;
};

} // namespace tactus::dds
