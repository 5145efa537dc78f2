// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/ply_header.hpp"
#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

/// PLY: the header lists the elements and their properties; "vertex", "face" and "tristrips" are
/// read, all others skipped. A value of any type is read as a double, which represents each of them
/// exactly.
namespace tactus::detail
{

namespace
{

template <typename T>
double load(const char* bytes, bool swap)
{
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes, sizeof(T));
    if (swap)
    {
        std::reverse(raw.begin(), raw.end());
    }
    T value{};
    std::memcpy(&value, raw.data(), sizeof(T));
    return static_cast<double>(value);
}

class BinaryValues
{
public:
    BinaryValues(std::string_view bytes, bool big_endian) : bytes_(bytes), swap_(big_endian) {}

    std::optional<double> read(PlyType type)
    {
        const std::size_t size = size_of(type);
        if (remaining() < size)
        {
            return std::nullopt;
        }
        const char* from = bytes_.data() + at_;
        at_ += size;
        switch (type)
        {
        case PlyType::int8:
            return load<std::int8_t>(from, swap_);
        case PlyType::uint8:
            return load<std::uint8_t>(from, swap_);
        case PlyType::int16:
            return load<std::int16_t>(from, swap_);
        case PlyType::uint16:
            return load<std::uint16_t>(from, swap_);
        case PlyType::int32:
            return load<std::int32_t>(from, swap_);
        case PlyType::uint32:
            return load<std::uint32_t>(from, swap_);
        case PlyType::float32:
            return load<float>(from, swap_);
        case PlyType::float64:
            return load<double>(from, swap_);
        }
        return std::nullopt;
    }

    [[nodiscard]] static std::size_t least_bytes(PlyType type) { return size_of(type); }
    [[nodiscard]] std::size_t remaining() const { return bytes_.size() - at_; }
    [[nodiscard]] bool at_end() { return remaining() == 0; }
    [[nodiscard]] static std::string where() { return {}; }
    /// Reason why the last value of a property could not be read.
    [[nodiscard]] static std::string fault(const std::string& property)
    {
        return "the file ends at " + quote(property);
    }

private:
    std::string_view bytes_;
    bool swap_;
    std::size_t at_{0};
};

class TextValues
{
public:
    TextValues(std::string_view text, std::size_t first_line) : cursor_(text, first_line) {}

    std::optional<double> read(PlyType)
    {
        token_ = cursor_.next_token();
        return parse_number(token_);
    }

    /// Least size of a value in a text file: a digit and a blank.
    [[nodiscard]] static std::size_t least_bytes(PlyType) { return 2; }
    [[nodiscard]] std::size_t remaining() const { return cursor_.remaining() + 1; }
    [[nodiscard]] bool at_end() { return cursor_.next_token().empty(); }
    [[nodiscard]] std::string where() const { return fmt::format("line {}: ", cursor_.line()); }
    [[nodiscard]] std::string fault(const std::string& property) const
    {
        return token_.empty() ? "the file ends at " + quote(property)
                              : quote(property) + " is " + no_number(token_);
    }

private:
    TextCursor cursor_;
    std::string_view token_; ///< Token read last, for fault().
};

template <typename Values>
class PlyBody
{
public:
    PlyBody(const PlyHeader& header, Values values) : header_(header), values_(std::move(values)) {}

    Result<MeshFile, Refusal> read()
    {
        if (auto error = find_vertex_element())
        {
            return *error;
        }
        if (auto error = find_index_lists())
        {
            return *error;
        }
        for (const PlyElement& element : header_.elements)
        {
            if (auto error = read_element(element))
            {
                return *error;
            }
        }
        if (!values_.at_end())
        {
            file_.notes.push_back(values_.where() + "data after the last element left out");
        }
        polygons_.finish(file_.notes);
        return std::move(file_);
    }

private:
    enum class Role
    {
        passed_over,
        coordinate,
        polygon,
        strip,
    };

    std::optional<Refusal> find_vertex_element()
    {
        for (const PlyElement& element : header_.elements)
        {
            if (element.name != "vertex")
            {
                continue;
            }
            std::array<int, 3> seen{};
            for (const PlyProperty& property : element.properties)
            {
                if (const auto axis = axis_of(property))
                {
                    ++seen[*axis];
                }
            }
            if (vertices_ || seen != std::array<int, 3>{1, 1, 1})
            {
                return Refusal{"the header must have one vertex element with one x, y and z"};
            }
            vertices_ = element.count;
        }
        return vertices_ ? std::nullopt
                         : std::optional(Refusal{"the header has no vertex element"});
    }

    static std::optional<std::size_t> axis_of(const PlyProperty& property)
    {
        const std::size_t axis = std::string_view("xyz").find(lower(property.name));
        const bool found = property.name.size() == 1 && axis != std::string_view::npos;
        return found && !property.count_type ? std::optional(axis) : std::nullopt;
    }

    /// Finds the list of indices of each element that has one: by its name, or a face's only list
    /// of integers.
    std::optional<Refusal> find_index_lists()
    {
        constexpr std::array<std::string_view, 4> kNames{"vertex_indices", "vertex_index",
                                                         "vertex_indexes", "vertexindices"};
        for (const PlyElement& element : header_.elements)
        {
            std::vector<const PlyProperty*> named;
            std::vector<const PlyProperty*> whole;
            std::string all;
            for (const PlyProperty& property : element.properties)
            {
                const auto name = std::ranges::find(kNames, lower(property.name));
                if (property.count_type && name != kNames.end())
                {
                    named.push_back(&property);
                }
                if (property.count_type && is_whole(property.type))
                {
                    whole.push_back(&property);
                }
                all += (all.empty() ? "" : ", ") + quote(property.name);
            }
            if (!named.empty())
            {
                index_lists_.insert(index_lists_.end(), named.begin(), named.end());
            }
            else if (element.name == "face" && whole.size() == 1)
            {
                index_lists_.push_back(whole.front());
                file_.notes.push_back("the faces' list " + quote(whole.front()->name) +
                                      " is read as vertex_indices");
            }
            else if (element.name == "face" && element.count > 0)
            {
                return Refusal{"the faces have no list vertex_indices; their properties: " +
                               (all.empty() ? "none" : all)};
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] Role role_of(const PlyElement& element, const PlyProperty& property) const
    {
        if (element.name == "vertex" && axis_of(property))
        {
            return Role::coordinate;
        }
        if (std::ranges::find(index_lists_, &property) != index_lists_.end())
        {
            return element.name == "face"        ? Role::polygon
                   : element.name == "tristrips" ? Role::strip
                                                 : Role::passed_over;
        }
        return Role::passed_over;
    }

    std::optional<Refusal> read_element(const PlyElement& element)
    {
        std::size_t least = 0;
        std::vector<Role> roles;
        for (const PlyProperty& property : element.properties)
        {
            least += Values::least_bytes(property.count_type.value_or(property.type));
            roles.push_back(role_of(element, property));
        }
        if (least == 0)
        {
            return std::nullopt;
        }
        if (element.count > values_.remaining() / least)
        {
            return Refusal{fmt::format("the header declares {} x {} of at least {} bytes each, "
                                       "but only {} bytes are left",
                                       element.count, quote(element.name), least,
                                       values_.remaining())};
        }
        if (element.name == "vertex")
        {
            file_.mesh.positions.reserve(element.count);
        }
        for (std::uint64_t item = 0; item < element.count; ++item)
        {
            if (auto error = read_item(element, roles))
            {
                return Refusal{fmt::format("{}{} {} of {} (from 0): {}", values_.where(),
                                           printable(element.name), item, element.count, *error)};
            }
        }
        return std::nullopt;
    }

    /// The helpers below return the fault; read_element() adds the place.
    std::optional<std::string> read_item(const PlyElement& element, const std::vector<Role>& roles)
    {
        if (element.name == "vertex")
        {
            file_.mesh.positions.emplace_back();
        }
        for (std::size_t i = 0; i < roles.size(); ++i)
        {
            const PlyProperty& property = element.properties[i];
            auto error = property.count_type ? read_list(property, roles[i])
                                             : read_scalar(property, roles[i]);
            if (error)
            {
                return error;
            }
        }
        return std::nullopt;
    }

    std::optional<std::string> read_scalar(const PlyProperty& property, Role role)
    {
        const auto value = values_.read(property.type);
        if (!value)
        {
            return values_.fault(property.name);
        }
        if (role == Role::coordinate)
        {
            file_.mesh.positions.back()[*axis_of(property)] = *value;
        }
        return std::nullopt;
    }

    std::optional<std::string> read_list(const PlyProperty& property, Role role)
    {
        const auto count = values_.read(*property.count_type);
        if (!count || !(*count >= 0.0) || *count != std::floor(*count))
        {
            return count ? fmt::format("list {} has the length {}", quote(property.name), *count)
                         : values_.fault(property.name);
        }
        corners_.clear();
        strip_.clear();
        for (double i = 0.0; i < *count; i += 1.0)
        {
            const auto value = values_.read(property.type);
            if (!value)
            {
                return values_.fault(property.name);
            }
            if (role == Role::passed_over)
            {
                continue;
            }
            if (auto error = add_index(*value, role))
            {
                return error;
            }
        }
        if (role == Role::polygon)
        {
            polygons_.add(corners_);
        }
        return std::nullopt;
    }

    std::optional<std::string> add_index(double value, Role role)
    {
        const auto count = static_cast<double>(*vertices_);
        const bool names_vertex = value >= 0.0 && value < count &&
                                  value == static_cast<double>(static_cast<std::uint64_t>(value));
        if (role == Role::strip && value == -1.0)
        {
            strip_.clear();
            return std::nullopt;
        }
        if (!names_vertex)
        {
            return fmt::format("vertex index {} is not in 0..{}", value, count - 1.0);
        }
        const auto index = static_cast<std::uint32_t>(value);
        role == Role::strip ? add_to_strip(index) : corners_.push_back(index);
        return std::nullopt;
    }

    /// Adds a vertex to the strip. From the third on, each makes a face with the two before it;
    /// every second face is reversed so that all have the same winding. A triple with two equal
    /// vertices only steers the strip and makes no face.
    void add_to_strip(std::uint32_t index)
    {
        strip_.push_back(index);
        const std::size_t n = strip_.size();
        if (n < 3)
        {
            return;
        }
        const std::uint32_t a = strip_[n - 3];
        const std::uint32_t b = strip_[n - 2];
        if (a != b && b != index && index != a)
        {
            n % 2 == 1 ? file_.mesh.faces.push_back({a, b, index})
                       : file_.mesh.faces.push_back({b, a, index});
        }
    }

    const PlyHeader& header_;
    Values values_;
    std::optional<std::uint64_t> vertices_;
    MeshFile file_;
    PolygonSink polygons_{file_.mesh};
    std::vector<const PlyProperty*> index_lists_;
    std::vector<std::uint32_t> corners_;
    std::vector<std::uint32_t> strip_; ///< Vertices since the strip's last restart.
};

} // namespace

Result<MeshFile, Refusal> read_ply(std::string_view file_bytes)
{
    const std::string_view bytes = without_byte_order_mark(file_bytes);
    const auto header = read_ply_header(bytes);
    if (!header)
    {
        return header.error();
    }
    const PlyHeader& found = header.value();
    const std::string_view data = bytes.substr(found.bytes);
    if (found.format != PlyFormat::ascii)
    {
        return PlyBody(found, BinaryValues(data, found.format == PlyFormat::big_endian)).read();
    }
    auto file = PlyBody(found, TextValues(data, found.lines + 1)).read();
    if (file)
    {
        note_missing_line_end(bytes, file.value().notes);
    }
    return file;
}

} // namespace tactus::detail
