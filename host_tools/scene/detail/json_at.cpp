// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/detail/json_at.hpp"

#include "transport/base/printable.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace tactus::detail
{

namespace
{

using nlohmann::json;

/// Counts the values of a text without storing them, so that a text beyond the bounds is refused
/// before it is parsed.
class BoundsCheck final : public nlohmann::json_sax<json>
{
public:
    explicit BoundsCheck(std::size_t bytes) : bytes_(bytes) {}

    [[nodiscard]] const std::string& fault() const noexcept { return fault_; }

    bool null() override { return count(); }
    bool boolean(bool /*value*/) override { return count(); }
    bool number_integer(number_integer_t /*value*/) override { return count(); }
    bool number_unsigned(number_unsigned_t /*value*/) override { return count(); }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override
    {
        return count();
    }
    bool string(string_t& /*value*/) override { return count(); }
    bool binary(binary_t& /*value*/) override { return count(); }
    bool key(string_t& /*value*/) override { return count(); }
    bool start_object(std::size_t /*elements*/) override { return enter(); }
    bool end_object() override { return leave(); }
    bool start_array(std::size_t /*elements*/) override { return enter(); }
    bool end_array() override { return leave(); }

    bool parse_error(std::size_t position, const std::string& last_token,
                     const nlohmann::detail::exception& /*error*/) override
    {
        fault_ = position > bytes_ ? fmt::format("the JSON ends too early, at byte {}", bytes_)
                                   : fmt::format("is not JSON at byte {}, after '{}'", position,
                                                 printable(last_token, 24));
        return false;
    }

private:
    bool count()
    {
        if (++values_ <= kMaxJsonValues)
        {
            return true;
        }
        fault_ = fmt::format("has more than {} keys and values of JSON", kMaxJsonValues);
        return false;
    }
    bool enter()
    {
        if (++depth_ <= kMaxJsonDepth)
        {
            return count();
        }
        fault_ = fmt::format("its JSON is nested deeper than {}", kMaxJsonDepth);
        return false;
    }
    bool leave()
    {
        --depth_;
        return true;
    }

    std::size_t bytes_;
    std::size_t values_{0};
    std::size_t depth_{0};
    std::string fault_;
};

} // namespace

nlohmann::json parse_bounded_json(std::string_view text)
{
    BoundsCheck check(text.size());
    if (!json::sax_parse(text.begin(), text.end(), &check))
    {
        throw SceneFault{check.fault()};
    }
    return json::parse(text.begin(), text.end());
}

JsonAt::JsonAt(const nlohmann::json& value, std::string place)
    : value_(&value), place_(std::move(place))
{
}

std::optional<JsonAt> JsonAt::find(const std::string& key) const
{
    if (!value_->is_object())
    {
        refuse("must be an object");
    }
    const auto member = value_->find(key);
    if (member == value_->end())
    {
        return std::nullopt;
    }
    return JsonAt(*member, place_.empty() ? key : place_ + "." + key);
}

JsonAt JsonAt::at(const std::string& key) const
{
    const auto member = find(key);
    if (!member)
    {
        refuse("lacks '" + key + "'");
    }
    return *member;
}

JsonAt JsonAt::at(std::size_t index) const
{
    return {value_->at(index), fmt::format("{}[{}]", place_, index)};
}

std::size_t JsonAt::size() const
{
    if (!value_->is_array())
    {
        refuse("must be an array");
    }
    return value_->size();
}

std::size_t JsonAt::size_of(const std::string& key) const
{
    const auto member = find(key);
    return member ? member->size() : 0;
}

std::string JsonAt::name() const
{
    const auto member = find("name");
    return member && member->value_->is_string() ? member->text() : "";
}

double JsonAt::number() const
{
    if (!value_->is_number())
    {
        refuse("must be a number");
    }
    return value_->get<double>();
}

bool JsonAt::boolean() const
{
    if (!value_->is_boolean())
    {
        refuse("must be true or false");
    }
    return value_->get<bool>();
}

const std::string& JsonAt::text() const
{
    if (!value_->is_string())
    {
        refuse("must be a string");
    }
    return value_->get_ref<const std::string&>();
}

std::uint64_t JsonAt::whole(std::uint64_t most) const
{
    if (!value_->is_number_unsigned() || value_->get<std::uint64_t>() > most)
    {
        refuse(fmt::format("must be a whole number of 0 to {}", most));
    }
    return value_->get<std::uint64_t>();
}

std::size_t JsonAt::index_below(std::size_t count, std::string_view what) const
{
    if (!value_->is_number_unsigned() || value_->get<std::uint64_t>() >= count)
    {
        refuse(fmt::format("must be a whole number below {}, the count of {}", count, what));
    }
    return value_->get<std::size_t>();
}

void JsonAt::require_keys_among(std::string_view keys) const
{
    if (!value_->is_object())
    {
        refuse("must be an object");
    }
    const std::string known = fmt::format(" {} ", keys);
    for (const auto& member : value_->items())
    {
        if (known.find(fmt::format(" {} ", member.key())) == std::string::npos)
        {
            refuse(fmt::format("has an unknown key '{}'; known keys are {}",
                               printable(member.key()), keys));
        }
    }
}

void JsonAt::refuse(const std::string& what) const
{
    throw SceneFault{place_.empty() ? what : place_ + " " + what};
}

} // namespace tactus::detail
