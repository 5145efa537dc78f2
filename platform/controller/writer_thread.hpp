// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>

namespace tactus::hrtc
{

/// Calls a function periodically on a thread of ordinary priority, to write the contents of a
/// queue. Make it before the haptic thread, whose policy and processor it would inherit.
class WriterThread
{
public:
    /// Pause between two calls. The queues have room for about 300 ms at the highest rate.
    static constexpr std::chrono::milliseconds kPause{5};

    /// `step` is the function. The objects that it uses must outlive the thread.
    explicit WriterThread(std::function<void()> step)
        : step_(std::move(step)), thread_([this] { run(); })
    {
    }
    WriterThread(const WriterThread&) = delete;
    WriterThread& operator=(const WriterThread&) = delete;
    /// Waits for the end of the present call.
    ~WriterThread()
    {
        stopped_.store(true);
        thread_.join();
    }

private:
    void run()
    {
        while (!stopped_.load())
        {
            step_();
            std::this_thread::sleep_for(kPause);
        }
    }

    std::function<void()> step_;
    std::atomic<bool> stopped_{false};
    std::thread thread_;
};

} // namespace tactus::hrtc
