// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/kernel_choice.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace tactus::hrtc::test
{

namespace
{

TEST(KernelChoice, is_any_set_that_the_processor_runs)
{
    for (const Kernels* kernels : available_kernels())
    {
        const auto chosen = choose_kernels(kernels->name, available_kernels());
        ASSERT_TRUE(chosen);
        EXPECT_EQ(chosen.value(), kernels);
    }
}

TEST(KernelChoice, refuses_a_set_that_the_processor_lacks_and_names_those_it_has)
{
    const std::array<const Kernels*, 1> plain{&portable_kernels()};
    for (const char* name : {"avx2", "", "Portable"})
    {
        const auto chosen = choose_kernels(name, plain);
        ASSERT_FALSE(chosen);
        EXPECT_EQ(chosen.error().text, std::string("--kernels: '") + name +
                                           "' is none that this processor runs: portable");
    }
}

} // namespace

} // namespace tactus::hrtc::test
