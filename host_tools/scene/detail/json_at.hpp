// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tactus::detail
{

/// Reason why a scene file is refused, without its name. Thrown at any depth of the reader; only
/// the public functions of scene.hpp catch it and return it as a Refusal.
struct SceneFault
{
    std::string text;
};

/// Maximum number and nesting depth of a file's JSON values. A value of a few bytes of text takes
/// about 100 bytes of memory.
inline constexpr std::size_t kMaxJsonValues = 4'000'000;
inline constexpr std::size_t kMaxJsonDepth = 64;

/// Parses the text as JSON. Throws a SceneFault if it is invalid or beyond the bounds. Time and
/// memory are linear in the text.
[[nodiscard]] nlohmann::json parse_bounded_json(std::string_view text);

/// A value of a JSON document and its place there, such as "nodes[3].mesh". Each function throws a
/// SceneFault that begins with the place if the value is of another kind. The document must outlive
/// the JsonAt.
class JsonAt
{
public:
    JsonAt(const nlohmann::json& value, std::string place);

    /// Member of this object; if it is missing, find() returns none and at() throws.
    [[nodiscard]] std::optional<JsonAt> find(const std::string& key) const;
    [[nodiscard]] JsonAt at(const std::string& key) const;
    /// Element of this array, which has size() of them.
    [[nodiscard]] JsonAt at(std::size_t index) const;
    [[nodiscard]] std::size_t size() const;
    /// Size of a member that is an array; 0 if it is missing.
    [[nodiscard]] std::size_t size_of(const std::string& key) const;
    /// Member "name" if it is a text, otherwise empty.
    [[nodiscard]] std::string name() const;

    [[nodiscard]] double number() const; ///< Finite, since JSON has no other numbers.
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] const std::string& text() const;
    /// Unsigned integer of at most `most`.
    [[nodiscard]] std::uint64_t whole(std::uint64_t most) const;
    /// Index below `count`; `what` names the indexed list in the message.
    [[nodiscard]] std::size_t index_below(std::size_t count, std::string_view what) const;

    /// Throws unless each key of this object is in `keys`, which are separated by blanks.
    void require_keys_among(std::string_view keys) const;

    [[noreturn]] void refuse(const std::string& what) const;

    [[nodiscard]] const nlohmann::json& json() const noexcept { return *value_; }
    [[nodiscard]] const std::string& place() const noexcept { return place_; }

private:
    const nlohmann::json* value_;
    std::string place_; ///< Place; empty for the whole document.
};

} // namespace tactus::detail
