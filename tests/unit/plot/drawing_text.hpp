// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/count_of.hpp"

#include <cstdlib>
#include <string>
#include <vector>

/// What tests read out of a drawing's text.
namespace tactus::plot::test
{

using tactus::test::count_of;

/// The number behind each of these.
inline std::vector<double> numbers_behind(const std::string& text, const std::string& part)
{
    std::vector<double> numbers;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    {
        numbers.push_back(std::strtod(text.c_str() + at + part.size(), nullptr));
    }
    return numbers;
}

struct Place
{
    double x, y;
};

/// Where the markers of this colour are; the legend's own, which is where its sample is, too.
inline std::vector<Place> markers_of(const std::string& body, const std::string& colour)
{
    std::vector<Place> places;
    const std::string start = "class=\"marker\" fill=\"" + colour + "\" transform=\"translate(";
    for (std::size_t at = body.find(start); at != std::string::npos; at = body.find(start, at + 1))
    {
        char* end = nullptr;
        const double x = std::strtod(body.c_str() + at + start.size(), &end);
        places.push_back({x, std::strtod(end, nullptr)});
    }
    return places;
}

} // namespace tactus::plot::test
