// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

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

} // namespace tactus::dds
