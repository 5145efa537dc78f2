// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/export/field_sink.hpp"

#include <string>

namespace tactus
{

/// Makes one JSON object of what is told, on one line. A value that is not known, and a number that
/// is not finite, is null; a set of words is an array, a vector one of three numbers, a rotation
/// one of four. Names and texts may hold anything: what is not printable ASCII becomes '?'.
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

    /// What is told until close() is of an object under this name, or, in a list, of its next item.
    void open(const char* name);
    void open_item();
    void close();
    void open_list(const char* name);
    void close_list();

    /// The object, "{...}" without a line's end; empties the sink.
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
