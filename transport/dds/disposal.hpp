// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace tactus::dds
{

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
