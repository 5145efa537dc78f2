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

Disposal::~Disposal()
{
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    has_news_.notify_one();
    if (thread_.joinable())
    {
        thread_.join();
    }
}

void Disposal::dispose(std::shared_ptr<void> owner)
{
    if (owner == nullptr)
    {
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        waiting_.push_back(std::move(owner));
        if (!thread_.joinable())
        {
            thread_ = std::thread([this] { run(); });
        }
    }
    has_news_.notify_one();
}

void Disposal::run()
{
    std::unique_lock lock(mutex_);
    for (;;)
    {
        has_news_.wait(lock, [this] { return is_over_ || !waiting_.empty(); });
        if (waiting_.empty())
        {
            return;
        }
        std::vector<std::shared_ptr<void>> batch = std::exchange(waiting_, {});
        lock.unlock();
        batch.clear();
        lock.lock();
    }
}

} // namespace tactus::dds
