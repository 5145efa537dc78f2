// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <ucontext.h>

namespace tactus::interleave
{

/// A function with a stack of its own, which runs until it pauses and goes on when it is resumed.
/// Everything happens on one thread; must run to its end before it is destroyed.
class Fiber
{
public:
    Fiber();
    Fiber(const Fiber&) = delete;
    Fiber& operator=(const Fiber&) = delete;
    Fiber(Fiber&&) = delete;
    Fiber& operator=(Fiber&&) = delete;
    ~Fiber() = default;

    /// Makes `body`, which must not throw, what the next resume() begins with.
    void start(std::function<void()> body);
    /// Runs the body until it pauses or ends.
    void resume();
    /// Inside of the body: back to the caller of resume().
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
    const void* outside_stack_{nullptr}; ///< For the address sanitizer, as the next one.
    std::size_t outside_bytes_{0};
};

} // namespace tactus::interleave
