// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/trajectory_file.hpp"

#include "host_tools/mesh/detail/text_cursor.hpp"
#include "rt_core/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <system_error>

namespace tactus::bench
{

namespace
{

using detail::parse_number;
using detail::quote;
using detail::TextCursor;
using Numbers = std::array<double, TrajectoryColumns::kQuantities>;

constexpr std::array<std::string_view, TrajectoryColumns::kQuantities> kNames{"t",  "x",  "y", "z",
                                                                              "fx", "fy", "fz"};
constexpr std::size_t kForce = 4; ///< Place of the force's first coordinate, or of its amount.

constexpr const char* kAllowed =
    "allowed are t, x, y, z, fx, fy, fz or fn, each once, - before one, and _";

std::size_t index_of(std::string_view name)
{
    if (name == "fn")
    {
        return kForce;
    }
    return static_cast<std::size_t>(std::ranges::find(kNames, name) - kNames.begin());
}

/// A line without its end, and whether it has one.
struct Line
{
    std::string_view text;
    bool has_end{false};
};

Line take_line(std::string_view& rest)
{
    const std::size_t end = rest.find('\n');
    const bool has_end = end != std::string_view::npos;
    const Line line{rest.substr(0, end), has_end};
    rest = has_end ? rest.substr(end + 1) : std::string_view{};
    return line;
}

bool is_comment(std::string_view line)
{
    const std::string_view first = TextCursor(line).next_token_in_line();
    return first.empty() || first[0] == '#' || first[0] == '%';
}

bool is_title(std::string_view line)
{
    return !parse_number(TextCursor(line).next_token_in_line());
}

/// Reads the lines of one text in turn.
class Parser
{
public:
    Parser(const TrajectoryColumns& columns, double metres_per_unit)
        : columns_(columns), metres_per_unit_(metres_per_unit)
    {
        trajectory_.has_force_direction = columns.has_force_direction();
    }

    std::optional<std::string> take(const Line& line)
    {
        if (!line.has_end)
        {
            return "no line end; the file may have been cut there";
        }
        if (is_comment(line.text))
        {
            return std::nullopt;
        }
        if (trajectory_.samples.empty() && is_title(line.text))
        {
            ++titles_;
            return titles_ <= kMaxTitleLines
                       ? std::nullopt
                       : std::optional(fmt::format("{} is no number; at most {} lines of titles "
                                                   "may come before the first sample",
                                                   first_of(line.text), kMaxTitleLines));
        }
        return take_sample(line.text);
    }

    [[nodiscard]] Trajectory& trajectory() { return trajectory_; }

private:
    static std::string first_of(std::string_view line)
    {
        return quote(TextCursor(line).next_token_in_line());
    }

    std::optional<std::string> take_sample(std::string_view line)
    {
        Numbers numbers{};
        if (auto fault = read_numbers(line, numbers))
        {
            return fault;
        }
        TrajectorySample sample;
        sample.time_s = numbers[0];
        sample.position_m = metres_per_unit_ * Vec3(numbers[1], numbers[2], numbers[3]);
        sample.force_n = Vec3(numbers[kForce], numbers[kForce + 1], numbers[kForce + 2]);
        if (auto fault = find_fault(sample))
        {
            return fault;
        }
        trajectory_.samples.push_back(sample);
        return std::nullopt;
    }

    std::optional<std::string> read_numbers(std::string_view line, Numbers& numbers) const
    {
        TextCursor cursor(line);
        std::size_t found = 0;
        for (std::string_view token = cursor.next_token_in_line(); !token.empty();
             token = cursor.next_token_in_line(), ++found)
        {
            const std::optional<double> number = parse_number(token);
            if (!number || !std::isfinite(*number))
            {
                return fmt::format("column {}: {} is no finite number", found + 1, quote(token));
            }
            const TrajectoryColumns::Quantity quantity =
                found < columns_.count() ? columns_.quantity(found) : TrajectoryColumns::Quantity{};
            if (quantity.index != TrajectoryColumns::kNone)
            {
                numbers[quantity.index] = quantity.sign * *number;
            }
        }
        return found == columns_.count() ? std::nullopt
                                         : std::optional(fmt::format("{} columns; a sample has {}",
                                                                     found, columns_.count()));
    }

    [[nodiscard]] std::optional<std::string> find_fault(const TrajectorySample& sample) const
    {
        const std::vector<TrajectorySample>& before = trajectory_.samples;
        if (before.size() == kMaxSamples)
        {
            return fmt::format("more than {} samples", kMaxSamples);
        }
        if (!before.empty() && !(sample.time_s > before.back().time_s))
        {
            return fmt::format("time {} s is not after the sample's before, {} s", sample.time_s,
                               before.back().time_s);
        }
        if (!(sample.position_m.lpNorm<Eigen::Infinity>() < kGoalRange_m))
        {
            return fmt::format("a coordinate is not within {} m of 0", kGoalRange_m);
        }
        if (!(sample.force_n.norm() <= kMaxTrajectoryForce_n))
        {
            return fmt::format("a force of more than {} N", kMaxTrajectoryForce_n);
        }
        return std::nullopt;
    }

    const TrajectoryColumns& columns_;
    double metres_per_unit_;
    std::size_t titles_{0};
    Trajectory trajectory_;
};

Result<std::string, TrajectoryError> read_bytes(const std::filesystem::path& path)
{
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code))
    {
        return TrajectoryError{std::filesystem::exists(path, code) ? "is not a regular file"
                                                                   : "no such file"};
    }
    const std::uintmax_t size = std::filesystem::file_size(path, code);
    if (code || size > kMaxTrajectoryBytes)
    {
        return TrajectoryError{
            code ? code.message() : fmt::format("{} bytes; at most {}", size, kMaxTrajectoryBytes)};
    }
    std::ifstream file(path, std::ios::binary);
    std::string bytes(size, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!file || static_cast<std::uintmax_t>(file.gcount()) != size)
    {
        return TrajectoryError{"can't be read"};
    }
    return bytes;
}

} // namespace

Result<TrajectoryColumns, TrajectoryError> TrajectoryColumns::parse(std::string_view text)
{
    TrajectoryColumns columns;
    std::array<bool, kQuantities> is_there{};
    bool has_amount = false;
    for (std::string_view rest = text; columns.count() <= kMaxTrajectoryColumns;)
    {
        const std::size_t comma = rest.find(',');
        std::string_view name = rest.substr(0, comma);
        Quantity quantity;
        if (name != "_")
        {
            quantity.sign = name.starts_with('-') ? -1.0 : 1.0;
            name.remove_prefix(name.starts_with('-') ? 1 : 0);
            quantity.index = index_of(name);
            if (quantity.index == kNone || is_there[quantity.index])
            {
                return TrajectoryError{
                    fmt::format("column {}: {}; {}", columns.count() + 1, quote(name), kAllowed)};
            }
            is_there[quantity.index] = true;
            has_amount = has_amount || name == "fn";
        }
        columns.quantities_.push_back(quantity);
        if (comma == std::string_view::npos)
        {
            break;
        }
        rest.remove_prefix(comma + 1);
    }
    columns.has_force_direction_ = !has_amount;
    if (columns.count() > kMaxTrajectoryColumns)
    {
        return TrajectoryError{fmt::format("more than {} columns", kMaxTrajectoryColumns)};
    }
    for (std::size_t i = 0; i < kQuantities; ++i)
    {
        const bool is_wanted = !(has_amount && i > kForce);
        if (is_there[i] != is_wanted)
        {
            return TrajectoryError{fmt::format(
                "{} {}; {}", kNames[i], is_wanted ? "is missing" : "stands beside fn", kAllowed)};
        }
    }
    return columns;
}

Result<Trajectory, TrajectoryError>
parse_trajectory(std::string_view text, const TrajectoryColumns& columns, double metres_per_unit)
{
    Parser parser(columns, metres_per_unit);
    std::size_t number = 0;
    while (!text.empty())
    {
        ++number;
        if (const auto fault = parser.take(take_line(text)))
        {
            return TrajectoryError{fmt::format("line {}: {}", number, *fault)};
        }
    }
    const std::size_t samples = parser.trajectory().samples.size();
    if (samples < kMinSamples)
    {
        return TrajectoryError{
            fmt::format("line {}: the file ends after {} samples; at least {} are needed", number,
                        samples, kMinSamples)};
    }
    return std::move(parser.trajectory());
}

Result<Trajectory, TrajectoryError> read_trajectory(const std::filesystem::path& path,
                                                    const TrajectoryColumns& columns,
                                                    double metres_per_unit)
{
    const auto bytes = read_bytes(path);
    if (!bytes)
    {
        return TrajectoryError{path.string() + ": " + bytes.error().text};
    }
    auto trajectory = parse_trajectory(bytes.value(), columns, metres_per_unit);
    if (!trajectory)
    {
        return TrajectoryError{path.string() + ": " + trajectory.error().text};
    }
    return trajectory;
}

} // namespace tactus::bench
