// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::plot
{

namespace
{

/// Powers of ten are reached up to rounding.
constexpr double kRounding = 1e-9;
/// Up to so many decades, 2 and 5 are marked as well.
constexpr double kFewDecades = 2.3;
constexpr std::array kSteps{1.0, 2.0, 5.0};

double power_of_ten(int exponent)
{
    return std::pow(10.0, exponent);
}

/// The least of 1, 2 and 5 times a power of ten that is not below the value, as a logarithm.
double round_up(double logarithm)
{
    const double decade = std::floor(logarithm + kRounding);
    for (const double step : kSteps)
    {
        if (decade + std::log10(step) >= logarithm - kRounding)
        {
            return decade + std::log10(step);
        }
    }
    return decade + 1.0;
}

/// 1, 2 or 5 times a power of ten, so that about `count` of them make the range.
double even_step(double range, std::size_t count)
{
    return std::pow(10.0, round_up(std::log10(range / static_cast<double>(count))));
}

std::string raised(int number)
{
    constexpr std::array<const char*, 10> kDigits{"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                                  "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    std::string text;
    for (const char c : std::to_string(number))
    {
        text += c == '-' ? "\u207B" : kDigits.at(static_cast<std::size_t>(c - '0'));
    }
    return text;
}

/// "1 000": thin spaces between groups of three.
std::string grouped(std::string digits)
{
    const std::size_t first = digits.starts_with('-') ? 1 : 0;
    const std::size_t point = std::min(digits.find('.'), digits.size());
    for (std::size_t at = point; at > first + 3;)
    {
        at -= 3;
        digits.insert(at, "\u2009");
    }
    return digits;
}

} // namespace

std::string number_text(double value)
{
    if (!std::isfinite(value))
    {
        return "none";
    }
    const double amount = std::abs(value);
    if (amount == 0.0)
    {
        return "0";
    }
    if (amount >= 0.9995e-4 && amount < 99'999.5)
    {
        const int decimals =
            std::clamp(3 - static_cast<int>(std::floor(std::log10(amount) + kRounding)), 0, 7);
        std::string text = fmt::format("{:.{}f}", value, decimals);
        if (decimals > 0)
        {
            text.erase(text.find_last_not_of('0') + 1);
            text.erase(text.find_last_not_of('.') + 1);
        }
        return grouped(text);
    }
    auto exponent = static_cast<int>(std::floor(std::log10(amount) + kRounding));
    std::string front = fmt::format("{:.3g}", value / power_of_ten(exponent));
    if (front == "10" || front == "-10")
    {
        ++exponent;
        front = value < 0.0 ? "-1" : "1";
    }
    const std::string power = "10" + raised(exponent);
    return front == "1" ? power : front == "-1" ? "-" + power : front + "\u00D7" + power;
}

Axis Axis::linear(double most)
{
    constexpr std::size_t kParts = 5;
    if (most == 0.0)
    {
        return {false, 0.0, 1.0};
    }
    const double step = even_step(most, kParts);
    return {false, 0.0, step * std::ceil(most / step - kRounding)};
}

Axis Axis::exactly(double least, double most)
{
    return {true, std::log10(least), std::log10(most)};
}

double Axis::share(double value) const
{
    const double place = is_logarithmic_ ? std::log10(value) : value;
    return std::clamp((place - least_) / (most_ - least_), 0.0, 1.0);
}

bool Axis::holds(double value) const
{
    if (!std::isfinite(value) || (is_logarithmic_ && value <= 0.0))
    {
        return false;
    }
    const double place = is_logarithmic_ ? std::log10(value) : value;
    return place > least_ && place < most_;
}

std::vector<Tick> Axis::ticks(std::size_t most) const
{
    return is_logarithmic_ ? decade_ticks(most) : even_ticks(most);
}

std::vector<Tick> Axis::even_ticks(std::size_t most) const
{
    const double step = even_step(most_ - least_, most);
    const auto first = static_cast<int>(std::ceil(least_ / step - kRounding));
    const auto last = static_cast<int>(std::floor(most_ / step + kRounding));
    std::vector<Tick> ticks;
    for (int i = first; i <= last; ++i)
    {
        const double value = i * step;
        ticks.push_back({share(value), number_text(value)});
    }
    return ticks;
}

std::vector<Tick> Axis::decade_ticks(std::size_t most) const
{
    const auto first = static_cast<int>(std::floor(least_ + kRounding));
    const auto last = static_cast<int>(std::floor(most_ + kRounding));
    const bool has_few = most_ - least_ <= kFewDecades;
    const int room = std::max(static_cast<int>(most), 2);
    const int every = has_few ? 1 : (last - first + room - 1) / room;
    std::vector<Tick> ticks;
    for (int decade = first; decade <= last; decade += every)
    {
        for (const double step : kSteps)
        {
            const double place = decade + std::log10(step);
            const bool is_wanted = step == 1.0 || has_few;
            if (is_wanted && place >= least_ - kRounding && place <= most_ + kRounding)
            {
                const double value = step * power_of_ten(decade);
                ticks.push_back({share(value), number_text(value)});
            }
        }
    }
    return ticks;
}

} // namespace tactus::plot
