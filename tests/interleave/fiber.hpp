// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <ucontext.h>

namespace tactus::interleave
{

/// Function with its own stack, which runs until it pauses and continues when resumed. Everything
/// is on one thread; it must end before it is destroyed.
class Fiber
{
public:
    Fiber();
    Fiber(const Fiber&) = delete;
    Fiber& operator=(const Fiber&) = delete;

    /// Sets the `body` of the next resume(), which must not throw.
    void start(std::function<void()> body);
    /// Runs the body until it pauses or ends.
    void resume();
    /// Returns from the body to the caller of resume().
    void pause();
    [[nodiscard]] bool is_done() const noexcept { return is_done_; }

private:
    static constexpr std::size_t kStackBytes = std::size_t{256} << 10U;

    static void enter(unsigned high, unsigned low);
    void run();

    std::unique_ptr<std::byte[]> stack_; // NOLINT: not a container, a stack.
    ucontext_t inside_{};
    ucontext_t outside_{};
    std::function<void()> body_;
    bool is_done_{true};
    const void* outside_stack_{nullptr}; ///< Stack bounds for the address sanitizer.
    std::size_t outside_bytes_{0};
};

} // namespace tactus::interleave
