// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/brake_latch.hpp"
#include "platform/devices/plugin/device_plugin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <cstdint>
#include <cstdio>
#include <string>
#include <thread>

namespace tactus::test
{
namespace
{

/// Refusal without the file's name in front.
std::string refusal_of(const std::string& path, const char* words)
{
    const auto device = load_device(path, {1'000, {}, words});
    if (device)
    {
        return "not refused";
    }
    const std::string& text = device.error().text;
    EXPECT_TRUE(text.starts_with(path + ": ")) << text;
    return text.substr(std::min(text.size(), path.size() + 2));
}

TEST(DevicePlugin, a_library_that_makes_no_device_is_refused_with_its_name)
{
    EXPECT_EQ(refusal_of(TACTUS_FAULTY_PLUGIN, "refuses"), "is not plugged in");
    EXPECT_EQ(refusal_of(TACTUS_FAULTY_PLUGIN, ""),
              "its TACTUS_DEVICE_PLUGIN returned no device and no reason");
    EXPECT_EQ(refusal_of(TACTUS_FAULTY_PLUGIN, "throws"),
              "its TACTUS_DEVICE_PLUGIN threw: no such port");
    EXPECT_EQ(refusal_of(TACTUS_FAULTY_PLUGIN, "throws a number"),
              "its TACTUS_DEVICE_PLUGIN threw an exception that is no std::exception");
    EXPECT_EQ(refusal_of(TACTUS_EMPTY_PLUGIN, ""),
              "is no device library: its TACTUS_DEVICE_PLUGIN has no function");
}

TEST(DevicePlugin, a_guard_that_a_library_refuses_is_refused_with_its_name)
{
    const auto refusal = [](const char* words)
    {
        const auto guard = load_guard(TACTUS_FAULTY_PLUGIN, {1'000, {}, words});
        return guard ? std::string("not refused") : guard.error().text;
    };
    const std::string name = std::string(TACTUS_FAULTY_PLUGIN) + ": ";
    EXPECT_EQ(refusal("no guard"), name + "has no second line to its motors");
    EXPECT_EQ(refusal(""), name + "its TACTUS_DEVICE_PLUGIN returned no guard and no reason");
    EXPECT_EQ(refusal("throws"), name + "its TACTUS_DEVICE_PLUGIN threw: no such port");
    EXPECT_FALSE(load_guard("nowhere.so", {1'000, {}, ""}));
}

constexpr MonotonicTime kBegan{1'000'000'000};

MonotonicTime after_ms(std::int64_t ms)
{
    return kBegan + milliseconds(ms);
}

TEST(BrakeLatch, takes_all_at_once_or_fades)
{
    BrakeLatch latch;
    EXPECT_FALSE(latch.is_on());
    EXPECT_FALSE(latch.is_on_at(after_ms(1'000'000)));
    EXPECT_EQ(latch.share_at(after_ms(1'000'000)), 1.0);
    EXPECT_EQ(latch.before(after_ms(7)), after_ms(7));

    latch.brake_softly(kBegan);
    EXPECT_TRUE(latch.is_on());
    EXPECT_FALSE(latch.is_on_at(after_ms(-1)));
    EXPECT_EQ(latch.share_at(after_ms(-1)), 1.0);
    EXPECT_EQ(latch.share_at(kBegan), 1.0);
    EXPECT_NEAR(latch.share_at(after_ms(10)), 0.8, 1e-9);
    EXPECT_EQ(latch.share_at(after_ms(50)), 0.0);
    EXPECT_EQ(latch.before(after_ms(7)), kBegan);
    latch.brake_softly(after_ms(20));
    EXPECT_NEAR(latch.share_at(after_ms(30)), 0.4, 1e-9) << "a second one begins nothing";

    latch.brake(after_ms(30));
    EXPECT_EQ(latch.share_at(after_ms(30)), 0.0);
    EXPECT_EQ(latch.before(after_ms(40)), kBegan) << "it began with the fade";
    latch.brake_softly(after_ms(40));
    EXPECT_EQ(latch.share_at(after_ms(40)), 0.0) << "at once stays at once";
    latch.release();
    EXPECT_FALSE(latch.is_on());
}

TEST(BrakeLatch, yields_a_fade_to_one_write_and_no_brake_at_once)
{
    BrakeLatch latch;
    EXPECT_TRUE(latch.lets_through());
    EXPECT_FALSE(latch.try_yield(kBegan)) << "it is off";
    latch.brake_softly(kBegan);
    EXPECT_FALSE(latch.lets_through()) << "nobody has released it";
    EXPECT_TRUE(latch.try_yield(after_ms(49)));
    EXPECT_TRUE(latch.lets_through());
    EXPECT_FALSE(latch.is_on());

    latch.brake_softly(kBegan);
    EXPECT_TRUE(latch.try_yield(after_ms(10)));
    latch.brake(after_ms(11));
    EXPECT_FALSE(latch.lets_through());
    EXPECT_FALSE(latch.try_yield(after_ms(12)));
    latch.release();

    latch.brake_softly(kBegan);
    EXPECT_FALSE(latch.try_yield(after_ms(50))) << "the fade is over";
    EXPECT_FALSE(latch.lets_through());
}

/// The start of one brake with the next one's kind would be an unrequested fade.
TEST(BrakeLatch, shows_no_fade_while_others_brake_at_once_and_release)
{
    constexpr int kRounds = 500'000;
    BrakeLatch latch;
    std::atomic<bool> is_over{false};
    std::atomic<int> shares_between{0};
    std::thread reader(
        [&]
        {
            while (!is_over)
            {
                const double share = latch.share_at(after_ms(1));
                shares_between += share != 0.0 && share != 1.0 ? 1 : 0;
            }
        });
    for (int round = 0; round < kRounds; ++round)
    {
        latch.brake(kBegan);
        latch.release();
    }
    is_over = true;
    reader.join();
    EXPECT_EQ(shares_between, 0);
}

/// Either order; an immediate brake never becomes a fade, nor is it half released.
TEST(BrakeLatch, ends_on_at_once_or_off_when_a_brake_and_a_release_meet)
{
    constexpr int kRounds = 20'000;
    BrakeLatch latch;
    std::barrier both(2);
    std::thread braker(
        [&]
        {
            for (int round = 0; round < kRounds; ++round)
            {
                both.arrive_and_wait();
                latch.brake(after_ms(1));
                both.arrive_and_wait();
            }
        });
    int on = 0;
    int wrong = 0;
    for (int round = 0; round < kRounds; ++round)
    {
        latch.brake_softly(kBegan);
        both.arrive_and_wait();
        for (int spin = round % 64; spin > 0; --spin)
        {
            static_cast<void>(latch.is_on());
        }
        latch.release();
        both.arrive_and_wait();
        on += latch.is_on() ? 1 : 0;
        wrong += latch.share_at(after_ms(2)) != (latch.is_on() ? 0.0 : 1.0) ? 1 : 0;
        latch.release();
    }
    braker.join();
    EXPECT_EQ(wrong, 0);
    std::printf("[ meetings ] the brake came last in %d of %d\n", on, kRounds);
}

} // namespace
} // namespace tactus::test
