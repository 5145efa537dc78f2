// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/entity.hpp"

#include <dds/dds.h>

#include <utility>

namespace tactus::dds
{

Entity::Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}

Entity& Entity::operator=(Entity&& other) noexcept
{
    std::swap(handle_, other.handle_);
    return *this;
}

Entity::~Entity()
{
    if (is_valid())
    {
        dds_delete(handle_);
    }
}

} // namespace tactus::dds
