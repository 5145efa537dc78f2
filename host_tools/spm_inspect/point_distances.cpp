// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "host_tools/spm_inspect/options.hpp"
#include "transport/store/static_model.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <iterator>
#include <span>

namespace tactus
{

namespace
{

const char* side_name(Side side)
{
    switch (side)
    {
    case Side::outside:
        return "outside";
    case Side::inside:
        return "inside";
    default:
        return "unsigned";
    }
}

std::string as_text(std::span<const PointDistance> answers)
{
    std::string text = "# lower_m upper_m side nearest_x_m nearest_y_m nearest_z_m\n";
    for (const PointDistance& answer : answers)
    {
        fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {}\n", answer.lower_m,
                       answer.upper_m, side_name(answer.side), answer.nearest_m.x(),
                       answer.nearest_m.y(), answer.nearest_m.z());
    }
    return text;
}

nlohmann::json as_list(std::span<const PointDistance> answers)
{
    nlohmann::json list = nlohmann::json::array();
    for (const PointDistance& answer : answers)
    {
        const Vec3& nearest_m = answer.nearest_m;
        list.push_back({{"lower_m", answer.lower_m},
                        {"upper_m", answer.upper_m},
                        {"side", side_name(answer.side)},
                        {"nearest_m", {nearest_m.x(), nearest_m.y(), nearest_m.z()}}});
    }
    return list;
}

} // namespace

Result<std::vector<Vec3>, Refusal> parse_points(std::string_view text)
{
    std::vector<Vec3> points_m;
    detail::TextCursor cursor(detail::without_byte_order_mark(text));
    do
    {
        std::string_view token = cursor.next_token_in_line();
        if (token.empty() || token.front() == '#')
        {
            continue;
        }
        Vec3 point_m(0.0, 0.0, 0.0);
        for (double& coordinate : point_m)
        {
            const auto number = detail::parse_number(token);
            if (!number || !std::isfinite(*number))
            {
                return cursor.error(token.empty()
                                        ? "has fewer than the three numbers x y z"
                                        : detail::quote(token) + " is not a finite number");
            }
            coordinate = *number;
            token = cursor.next_token_in_line();
        }
        if (!token.empty())
        {
            return cursor.error("has more than the three numbers x y z");
        }
        points_m.push_back(point_m);
    } while (cursor.skip_line());
    return points_m;
}

std::optional<std::string> print_distances(const std::string& model_file,
                                           const std::string& point_file, bool as_json)
{
    const std::string name = detail::input_name(point_file);
    const auto text = detail::read_input(point_file);
    if (!text)
    {
        return fmt::format("{}: {}", name, text.error().text);
    }
    const auto points_m = parse_points(text.value());
    if (!points_m)
    {
        return fmt::format("{}: {}", name, points_m.error().text);
    }
    const auto model = StaticModel::open(model_file);
    if (!model)
    {
        return model.error().text;
    }
    std::vector<PointDistance> answers(points_m.value().size());
    if (const auto asked = model.value()->distances(points_m.value(), answers); !asked)
    {
        return fmt::format("{}: {}", name, asked.error().text);
    }
    fmt::print("{}", as_json ? nlohmann::json{{"distances", as_list(answers)}}.dump(2) + "\n"
                             : as_text(answers));
    return std::nullopt;
}

} // namespace tactus
