// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/detail/gltf_file.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tactus::detail
{

/// Throws a SceneFault about compressed data, which this reader does not decode, with a remedy.
[[noreturn]] void refuse_compressed(const JsonAt& json, std::string_view extension);

/// accessors[index] of a glTF file, of type SCALAR, VEC3 or VEC4: numbers in a buffer, with a
/// stride. A sparse accessor replaces single elements. The constructor checks all bounds, at no
/// cost for each element except for sparse ones; elements are decoded on access. The file must
/// outlive the accessor. Functions throw a SceneFault.
class GltfAccessor
{
public:
    GltfAccessor(GltfFile& file, std::size_t index);

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] const JsonAt& json() const noexcept { return json_; }

    /// Throws unless the elements can be indices: unsigned integers.
    void require_indices() const;
    /// Throws unless the elements can be positions: VEC3 of floats, or of small integers if the
    /// file has the extension KHR_mesh_quantization.
    void require_positions(const GltfFile& file) const;
    /// Throws unless an element has `width` numbers.
    void require_width(std::size_t width) const;

    /// Element `i` < count() of an accessor that passed require_indices().
    [[nodiscard]] std::uint32_t index(std::size_t i) const;
    /// Element `i` of `Width` numbers; throws if one is not finite.
    template <std::size_t Width>
    [[nodiscard]] std::array<double, Width> numbers(std::size_t i) const
    {
        std::array<double, Width> numbers{};
        read_numbers(i, numbers);
        return numbers;
    }

private:
    /// Types of a component, with the codes of the glTF standard, which are those of OpenGL.
    enum class Component : std::uint16_t
    {
        i8 = 5120,
        u8 = 5121,
        i16 = 5122,
        u16 = 5123,
        u32 = 5125,
        f32 = 5126,
        f64 = 5130, ///< Code from KHR_accessor_float64.
    };

    [[nodiscard]] static Component component_of(const JsonAt& json);
    [[nodiscard]] static std::size_t bytes_of(Component component);
    [[nodiscard]] static std::string_view view_of(GltfFile& file, const JsonAt& user,
                                                  std::size_t& stride);
    [[nodiscard]] static std::uint32_t whole_at(const char* at, Component component);

    void read_base(GltfFile& file);
    void read_sparse(GltfFile& file);
    [[nodiscard]] const char* element(std::size_t i) const;
    [[nodiscard]] double number_at(const char* at) const;
    void read_numbers(std::size_t i, std::span<double> numbers) const;

    JsonAt json_;
    Component component_;
    std::size_t width_; ///< Numbers in an element: 1, 3 or 4.
    std::size_t count_;
    bool is_normalized_{false};
    std::string_view base_; ///< Bytes from the first element on; empty if all elements are 0.
    std::size_t stride_{0};
    std::size_t sparse_count_{0};
    Component sparse_component_{Component::u8};
    std::string_view sparse_indices_; ///< Indices of the replaced elements, strictly ascending.
    std::string_view sparse_values_;  ///< Replacing elements, contiguous.
};

} // namespace tactus::detail
