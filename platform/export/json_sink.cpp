// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/field_sink.hpp"
#include "transport/base/printable.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

namespace tactus
{

namespace
{

void append_number(std::string& json, double value)
{
    std::isfinite(value) ? fmt::format_to(std::back_inserter(json), "{}", value)
                         : fmt::format_to(std::back_inserter(json), "null");
}

void append_text(std::string& json, std::string_view text)
{
    json += '"';
    for (const char c : text)
    {
        json += c == '"' || c == '\\' ? "\\" : "";
        json += is_printable(c) ? c : '?';
    }
    json += '"';
}

constexpr const char* kMaybeNumber = R"({"type":["number","null"]})";
constexpr const char* kMaybeNumbers =
    R"({"type":["array","null"],"items":{"type":["number","null"]}})";

} // namespace

void JsonSink::key(const char* name)
{
    json_ += json_.empty() ? "{" : json_.back() == '{' ? "" : ",";
    append_text(json_, name);
    json_ += ':';
}

void JsonSink::number(const char* name, const std::optional<double>& value)
{
    key(name);
    append_number(json_, value.value_or(NAN));
}

void JsonSink::integer(const char* name, const std::optional<std::int64_t>& value)
{
    key(name);
    json_ += value ? fmt::format_int(*value).c_str() : "null";
}

void JsonSink::flag(const char* name, bool value)
{
    key(name);
    json_ += value ? "true" : "false";
}

void JsonSink::text(const char* name, std::string_view value)
{
    key(name);
    append_text(json_, value);
}

void JsonSink::words(const char* name, const std::vector<std::string>& value)
{
    key(name);
    json_ += '[';
    for (const std::string& word : value)
    {
        json_ += json_.back() == '[' ? "" : ",";
        append_text(json_, word);
    }
    json_ += ']';
}

void JsonSink::vector(const char* name, const std::optional<Vec3>& value)
{
    key(name);
    if (!value)
    {
        json_ += "null";
        return;
    }
    for (int i = 0; i < 3; ++i)
    {
        json_ += i == 0 ? '[' : ',';
        append_number(json_, (*value)(i));
    }
    json_ += ']';
}

void JsonSink::rotation(const char* name, const std::optional<Eigen::Quaterniond>& value)
{
    key(name);
    if (!value)
    {
        json_ += "null";
        return;
    }
    for (int i = 0; i < 4; ++i) // Eigen keeps x, y, z, w.
    {
        json_ += i == 0 ? '[' : ',';
        append_number(json_, value->coeffs()(i));
    }
    json_ += ']';
}

void JsonSink::open(const char* name)
{
    key(name);
    json_ += '{';
}

void JsonSink::open_item()
{
    json_ += json_.back() == '[' ? "{" : ",{";
}

void JsonSink::close()
{
    json_ += '}';
}

void JsonSink::open_list(const char* name)
{
    key(name);
    json_ += '[';
}

void JsonSink::close_list()
{
    json_ += ']';
}

std::string JsonSink::take()
{
    return std::exchange(json_, {}) + "}";
}

void SchemaSink::add(const char* name, const char* type)
{
    properties_ += properties_.empty() ? "" : ",";
    append_text(properties_, name);
    properties_ += ':';
    properties_ += type;
}

void SchemaSink::number(const char* name, const std::optional<double>& /*value*/)
{
    add(name, kMaybeNumber);
}

void SchemaSink::integer(const char* name, const std::optional<std::int64_t>& /*value*/)
{
    add(name, R"({"type":["integer","null"]})");
}

void SchemaSink::flag(const char* name, bool /*value*/)
{
    add(name, R"({"type":"boolean"})");
}

void SchemaSink::text(const char* name, std::string_view /*value*/)
{
    add(name, R"({"type":"string"})");
}

void SchemaSink::words(const char* name, const std::vector<std::string>& /*value*/)
{
    add(name, R"({"type":"array","items":{"type":"string"}})");
}

void SchemaSink::vector(const char* name, const std::optional<Vec3>& /*value*/)
{
    add(name, kMaybeNumbers);
}

void SchemaSink::rotation(const char* name, const std::optional<Eigen::Quaterniond>& /*value*/)
{
    add(name, kMaybeNumbers);
}

std::string SchemaSink::take()
{
    return R"({"type":"object","properties":{)" + std::exchange(properties_, {}) + "}}";
}

} // namespace tactus
