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

/// Why a scene file is refused, without its name. Thrown from any depth of the reader and caught by
/// the public functions of scene.hpp alone, which return it as a Refusal.
struct SceneFault
{
    std::string text;
};

/// Bounds of a file's JSON. They bound what a value of a few bytes may cost: some 100 bytes each.
inline constexpr std::size_t kMaxJsonValues = 4'000'000;
inline constexpr std::size_t kMaxJsonDepth = 64;

/// The text as JSON. Throws a SceneFault where it is none, and where it is beyond the bounds.
/// Takes time and memory linear in the text.
[[nodiscard]] nlohmann::json parse_bounded_json(std::string_view text);

/// A value of a JSON document and where it stands there, such as "nodes[3].mesh". Each function
/// throws a SceneFault that begins with that place when the value is of another kind. The document
/// must outlive it.
class JsonAt
{
public:
    JsonAt(const nlohmann::json& value, std::string place);

    /// A member of this object; find() returns none where there is none, at() throws.
    [[nodiscard]] std::optional<JsonAt> find(const std::string& key) const;
    [[nodiscard]] JsonAt at(const std::string& key) const;
    /// An element of this array, which has size() of them.
    [[nodiscard]] JsonAt at(std::size_t index) const;
    [[nodiscard]] std::size_t size() const;
    /// size() of a member that is an array; 0 where there is none.
    [[nodiscard]] std::size_t size_of(const std::string& key) const;
    /// The member "name", where it is a text; otherwise empty.
    [[nodiscard]] std::string name() const;

    [[nodiscard]] double number() const; ///< Finite: JSON knows nothing else.
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] const std::string& text() const;
    /// A whole number of at most `most`.
    [[nodiscard]] std::uint64_t whole(std::uint64_t most) const;
    /// The number of one of `count` things that `what` names, for the message.
    [[nodiscard]] std::size_t index_below(std::size_t count, std::string_view what) const;

    /// Throws unless each key of this object is one of those, which are separated by blanks.
    void require_keys_among(std::string_view keys) const;

    [[noreturn]] void refuse(const std::string& what) const;

    [[nodiscard]] const nlohmann::json& json() const noexcept { return *value_; }
    [[nodiscard]] const std::string& place() const noexcept { return place_; }

private:
    const nlohmann::json* value_;
    std::string place_; ///< Empty: the whole document.
};

} // namespace tactus::detail
