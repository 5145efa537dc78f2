// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a mesh file of the kind in TACTUS_FUZZ_EXTENSION. An accepted mesh is passed to
/// prepare_mesh(), as in every program.
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/scratch_file.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace tactus::fuzz
{

namespace
{

void require_clear(const std::vector<std::string>& notes)
{
    require(std::ranges::all_of(notes, is_one_clear_line), "a note is one clear line");
}

void check_read(const MeshFile& file)
{
    const TriangleMesh& mesh = file.mesh;
    require(!mesh.faces.empty() && mesh.faces.size() <= (std::size_t{1} << 29U),
            "an accepted mesh has 1 .. 2^29 faces");
    for (const auto& [x, y, z] : mesh.positions)
    {
        require(std::isfinite(x) && std::isfinite(y) && std::isfinite(z),
                "accepted coordinates are finite");
    }
    for (const auto& [a, b, c] : mesh.faces)
    {
        require(std::max({a, b, c}) < mesh.positions.size(), "accepted indices name vertices");
    }
    require_clear(file.notes);
}

void check_prepared(const PreparedMesh& prepared, unsigned bits)
{
    const QuantisedMesh& mesh = prepared.mesh;
    require(!mesh.faces.empty(), "a prepared mesh has faces");
    for (const auto& [x, y, z] : mesh.positions)
    {
        require(std::min({x, y, z}) >= 0 && std::max({x, y, z}) < (1 << bits),
                "prepared coordinates have their bits");
    }
    for (const auto& [a, b, c] : mesh.faces)
    {
        require(std::max({a, b, c}) < mesh.positions.size() && a != b && b != c && c != a,
                "a prepared face has three vertices");
    }
    require(prepared.diagonal_m >= 1e-6 && prepared.diagonal_m <= 1e6 &&
                prepared.quantisation_m <= prepared.quantum_m,
            "a prepared mesh has a size, and lies on its grid");
    require_clear(prepared.notes);
}

void prepare(const TriangleMesh& mesh, const PrepareOptions& options)
{
    if (const auto prepared = prepare_mesh(mesh, options))
    {
        check_prepared(prepared.value(), options.position_bits);
    }
    else
    {
        require(is_one_clear_line(prepared.error().text), "a refusal is one clear line");
    }
}

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tactus;
    static fuzz::ScratchFile scratch("mesh" TACTUS_FUZZ_EXTENSION);
    scratch.replace(std::as_bytes(std::span(data, size)));
    const auto file = read_mesh_file(scratch.path());
    if (!file)
    {
        fuzz::require(fuzz::is_clear_refusal(file.error().text, scratch.path().string()),
                      "a refusal is one clear line that begins with the file's name");
        return 0;
    }
    ++fuzz::accepted_inputs;
    fuzz::check_read(file.value());
    fuzz::prepare(file.value().mesh, {.position_bits = 16});
    fuzz::prepare(file.value().mesh, {.fit_diagonal_m = 1.0, .position_bits = 24});
    return 0;
}
