// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/interleave/fiber.hpp"

#include "tests/shared/sanitizers.hpp"

#include <cstdint>
#include <utility>

// The address sanitizer must be notified of every change of the stack.
#if TACTUS_HAS_ADDRESS_SANITIZER
#include <sanitizer/common_interface_defs.h>
#endif

namespace tactus::interleave
{

namespace
{

void begin_switch(void** own, const void* to, std::size_t bytes)
{
#if TACTUS_HAS_ADDRESS_SANITIZER
    __sanitizer_start_switch_fiber(own, to, bytes);
#else
    static_cast<void>(own);
    static_cast<void>(to);
    static_cast<void>(bytes);
#endif
}

void end_switch(void* own, const void** from, std::size_t* bytes)
{
#if TACTUS_HAS_ADDRESS_SANITIZER
    __sanitizer_finish_switch_fiber(own, from, bytes);
#else
    static_cast<void>(own);
    static_cast<void>(from);
    static_cast<void>(bytes);
#endif
}

} // namespace

Fiber::Fiber() : stack_(new std::byte[kStackBytes]) {}

void Fiber::start(std::function<void()> body)
{
    body_ = std::move(body);
    is_done_ = false;
    ::getcontext(&inside_);
    inside_.uc_stack.ss_sp = stack_.get();
    inside_.uc_stack.ss_size = kStackBytes;
    inside_.uc_link = &outside_;
    const auto self =
        reinterpret_cast<std::uintptr_t>(this); // Passed as two ints, the only parameters possible.
    ::makecontext(&inside_, reinterpret_cast<void (*)()>(&Fiber::enter), 2,
                  static_cast<unsigned>(std::uint64_t{self} >> 32U), static_cast<unsigned>(self));
}

void Fiber::resume()
{
    void* own = nullptr;
    begin_switch(&own, stack_.get(), kStackBytes);
    ::swapcontext(&outside_, &inside_);
    end_switch(own, nullptr, nullptr);
}

void Fiber::pause()
{
    void* own = nullptr;
    begin_switch(&own, outside_stack_, outside_bytes_);
    ::swapcontext(&inside_, &outside_);
    end_switch(own, &outside_stack_, &outside_bytes_);
}

void Fiber::enter(unsigned high, unsigned low)
{
    const std::uint64_t self = (std::uint64_t{high} << 32U) | low;
    reinterpret_cast<Fiber*>(static_cast<std::uintptr_t>(self))->run();
}

void Fiber::run()
{
    end_switch(nullptr, &outside_stack_, &outside_bytes_);
    body_();
    is_done_ = true;
    begin_switch(nullptr, outside_stack_, outside_bytes_); // Final: this stack is left.
}

} // namespace tactus::interleave
