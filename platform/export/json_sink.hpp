// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/export/field_sink.hpp"

#include <string>

namespace tactus
{

/// Makes one JSON object on one line. An unknown value and a number that is not finite are null; a
/// set of words is an array, a vector one of three numbers, a rotation one of four. Characters
/// other than printable ASCII in names and texts become '?'.
class JsonSink final : public FieldSink
{
public:
    void number(const char* name, const std::optional<double>& value) override;
    void integer(const char* name, const std::optional<std::int64_t>& value) override;
    void flag(const char* name, bool value) override;
    void text(const char* name, std::string_view value) override;
    void words(const char* name, const std::vector<std::string>& value) override;
    void vector(const char* name, const std::optional<Vec3>& value) override;
    void rotation(const char* name, const std::optional<Eigen::Quaterniond>& value) override;

    /// Opens an object: under this name, or as the next item of the open list. Values until close()
    /// belong to the object.
    void open(const char* name);
    void open_item();
    void close();
    void open_list(const char* name);
    void close_list();

    /// Returns the object, "{...}" without a line's end, and empties the sink.
    [[nodiscard]] std::string take();

private:
    void key(const char* name);

    std::string json_;
};

/// JSON Schema of the object that a JsonSink makes of the same calls.
class SchemaSink final : public FieldSink
{
public:
    void number(const char* name, const std::optional<double>& value) override;
    void integer(const char* name, const std::optional<std::int64_t>& value) override;
    void flag(const char* name, bool value) override;
    void text(const char* name, std::string_view value) override;
    void words(const char* name, const std::vector<std::string>& value) override;
    void vector(const char* name, const std::optional<Vec3>& value) override;
    void rotation(const char* name, const std::optional<Eigen::Quaterniond>& value) override;

    [[nodiscard]] std::string take();

private:
    void add(const char* name, const char* type);

    std::string properties_;
};

} // namespace tactus
