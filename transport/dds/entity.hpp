// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

namespace tactus::dds
{

/// Owns one entity of Cyclone DDS, and with it the entities created below that one.
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

    /// Handle of the C API; negative values are its error codes.
    [[nodiscard]] std::int32_t get() const noexcept { return handle_; }
    [[nodiscard]] bool is_valid() const noexcept { return handle_ > 0; }

private:
    std::int32_t handle_{0};
};

/// A reader or writer below its own subscriber or publisher, which carries the partition.
struct Endpoint
{
    Entity parent;
    std::int32_t handle{0};

    [[nodiscard]] bool is_valid() const noexcept { return parent.is_valid() && handle > 0; }
};

} // namespace tactus::dds
