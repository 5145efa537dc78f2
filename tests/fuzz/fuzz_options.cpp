// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a command line of hrtc and its option file: words, one a line, up to the first
/// empty line; then the file. No option of an accepted input is lost when they are written to a
/// file.
#include "platform/options/options.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "transport/base/exit_codes.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::fuzz
{

namespace
{

constexpr std::size_t kWordsMost = 64;

/// During its lifetime, the streams stdout and stderr of this process are in memory. Sanitizers and
/// libFuzzer keep the real ones.
class CapturedOutput
{
public:
    CapturedOutput()
    {
        std::fflush(stdout);
        stdout = out_.stream;
        stderr = error_.stream;
    }
    CapturedOutput(const CapturedOutput&) = delete;
    CapturedOutput& operator=(const CapturedOutput&) = delete;
    ~CapturedOutput()
    {
        stdout = out_.before;
        stderr = error_.before;
    }

    /// Text on stderr so far.
    [[nodiscard]] std::string error() const
    {
        std::fflush(error_.stream);
        return {error_.text, error_.bytes};
    }

private:
    /// A stream in memory, in place of one of the process.
    struct Memory
    {
        explicit Memory(FILE* replaced) : before(replaced)
        {
            require(stream != nullptr, "a stream in memory can be made");
        }
        Memory(const Memory&) = delete;
        Memory& operator=(const Memory&) = delete;
        ~Memory()
        {
            std::fclose(stream);
            std::free(text); // NOLINT(cppcoreguidelines-no-malloc): open_memstream()'s buffer.
        }

        char* text{nullptr};
        std::size_t bytes{0};
        FILE* stream{::open_memstream(&text, &bytes)};
        FILE* before;
    };

    Memory out_{stdout};
    Memory error_{stderr};
};

struct Parsed
{
    std::variant<hrtc::Options, int> result;
    std::string output; ///< Text on stderr.
};

Parsed parse(std::vector<std::string> words)
{
    std::vector<char*> arguments;
    for (std::string& word : words)
    {
        arguments.push_back(word.data());
    }
    const CapturedOutput captured; // Parsing opens no model and no device.
    auto result = hrtc::parse_options(static_cast<int>(arguments.size()), arguments.data(),
                                      hrtc::CommandForm{});
    return {std::move(result), captured.error()};
}

/// Words of the command line; `text` is then what follows them.
std::vector<std::string> take_words(std::string_view& text)
{
    std::vector<std::string> words{"hrtc"};
    while (!text.empty() && text.front() != '\n' && words.size() < kWordsMost)
    {
        const std::size_t end = std::min(text.find('\n'), text.size());
        // A word of a command line ends with a zero.
        words.emplace_back(std::string(text.substr(0, end)).c_str());
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    text.remove_prefix(text.starts_with('\n') ? 1 : 0);
    return words;
}

void replace_file(ScratchFile& file, std::string_view text)
{
    file.replace(std::as_bytes(std::span(text)));
}

void check_refusal(int code, std::string_view output)
{
    require(code == kExitDone || code == kExitFailed || code == kExitUsage,
            "the exit code is a known one");
    require(code == kExitDone || output.ends_with('\n'), "a refusal is a line");
    require(code == kExitDone || is_one_clear_line(output.substr(0, output.size() - 1)),
            "a refusal is one clear line");
    require(code == kExitDone || output.find("hrtc") != std::string_view::npos,
            "a refusal names the program");
}

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tactus;
    using namespace tactus::fuzz;
    static ScratchFile file("options.toml");
    std::string_view text(reinterpret_cast<const char*>(data), size);
    std::vector<std::string> words = take_words(text);
    if (!text.empty())
    {
        replace_file(file, text);
        words.insert(words.end(), {"--config", file.path().string()});
    }
    const Parsed first = parse(words);
    if (const int* code = std::get_if<int>(&first.result))
    {
        check_refusal(*code, first.output);
        return 0;
    }
    ++accepted_inputs;
    const std::string& written = std::get<hrtc::Options>(first.result).as_file;
    replace_file(file, written);
    const Parsed again = parse({"hrtc", "--config", file.path().string()});
    const auto* options = std::get_if<hrtc::Options>(&again.result);
    if (options == nullptr || options->as_file != written)
    {
        std::fprintf(stderr, "%s%s", written.c_str(), again.output.c_str());
    }
    require(options != nullptr, "options that are written to a file are accepted");
    require(options->as_file == written, "options that are written to a file are the same");
    return 0;
}
