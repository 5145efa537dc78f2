// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/field_sink.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::array kAxes{".x", ".y", ".z", ".w"};

} // namespace

void CsvSink::begin(Cells cells, std::string prefix)
{
    cells_ = cells;
    prefix_ = std::move(prefix);
}

/// Adds a cell without quotes, since no name or word contains a comma, quote or line's end.
void CsvSink::cell(const char* name, const char* suffix, std::string_view value)
{
    line_ += has_cells_ ? "," : "";
    has_cells_ = true;
    if (cells_ == Cells::names)
    {
        line_ += prefix_ + name + suffix;
    }
    else if (cells_ == Cells::values)
    {
        line_ += value;
    }
}

void CsvSink::number(const char* name, const std::optional<double>& value)
{
    cell(name, "", value ? fmt::format("{}", *value) : "");
}

void CsvSink::integer(const char* name, const std::optional<std::int64_t>& value)
{
    cell(name, "", value ? fmt::format("{}", *value) : "");
}

void CsvSink::flag(const char* name, bool value)
{
    cell(name, "", value ? "1" : "0");
}

void CsvSink::text(const char* name, std::string_view value)
{
    cell(name, "", value);
}

void CsvSink::words(const char* name, const std::vector<std::string>& value)
{
    cell(name, "", fmt::format("{}", fmt::join(value, " ")));
}

void CsvSink::vector(const char* name, const std::optional<Vec3>& value)
{
    for (int i = 0; i < 3; ++i)
    {
        cell(name, kAxes.at(static_cast<std::size_t>(i)),
             value ? fmt::format("{}", (*value)(i)) : "");
    }
}

void CsvSink::rotation(const char* name, const std::optional<Eigen::Quaterniond>& value)
{
    for (int i = 0; i < 4; ++i) // Eigen keeps x, y, z, w.
    {
        cell(name, kAxes.at(static_cast<std::size_t>(i)),
             value ? fmt::format("{}", value->coeffs()(i)) : "");
    }
}

std::string CsvSink::take()
{
    has_cells_ = false;
    return std::exchange(line_, {}) + "\r\n";
}

} // namespace tactus
