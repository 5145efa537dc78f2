// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// check_report REPORT [LEFT OP RIGHT]...: compares figures of a JSON report. LEFT is a key such as
/// answers.exact or pairs.0.tool, or several joined by '+'; its value is the number, the truth
/// value as 0 or 1, or the size of the list or object. OP is one of == < <= > >=. RIGHT is a
/// number, or NUMBER*KEY. Prints every comparison that fails; exits 1 then, and 2 if the report
/// cannot be read.

#include <nlohmann/json.hpp>

#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace
{

using Json = nlohmann::json;

double value_of(const Json& report, const std::string& key)
{
    std::string pointer = "/" + key;
    for (char& c : pointer)
    {
        c = c == '.' ? '/' : c;
    }
    const Json::json_pointer place(pointer);
    if (!report.contains(place))
    {
        throw std::runtime_error("there is no " + key);
    }
    const Json& value = report.at(place);
    if (value.is_number())
    {
        return value.get<double>();
    }
    if (value.is_boolean())
    {
        return value.get<bool>() ? 1.0 : 0.0;
    }
    if (value.is_string())
    {
        throw std::runtime_error(key + " is a text");
    }
    return static_cast<double>(value.size());
}

double sum_of(const Json& report, const std::string& keys)
{
    double sum = 0.0;
    std::istringstream stream(keys);
    for (std::string key; std::getline(stream, key, '+');)
    {
        sum += value_of(report, key);
    }
    return sum;
}

double right_side(const Json& report, const std::string& text)
{
    const std::size_t star = text.find('*');
    const double number = std::stod(text.substr(0, star));
    return star == std::string::npos ? number : number * value_of(report, text.substr(star + 1));
}

bool holds(double left, const std::string& op, double right)
{
    if (op == "==")
    {
        return !(left < right) && !(left > right);
    }
    if (op == "<" || op == "<=")
    {
        return op == "<" ? left < right : left <= right;
    }
    if (op == ">" || op == ">=")
    {
        return op == ">" ? left > right : left >= right;
    }
    throw std::runtime_error("no comparison " + op);
}

/// True if LEFT OP RIGHT holds; prints one line otherwise.
bool compare(const Json& report, const std::string& left, const std::string& op,
             const std::string& right)
{
    try
    {
        const double value = sum_of(report, left);
        const double wanted = right_side(report, right);
        if (holds(value, op, wanted))
        {
            return true;
        }
        std::cout << left << " is " << value << "; expected " << op << ' ' << right << '\n';
    }
    catch (const std::exception& error)
    {
        std::cout << left << ' ' << op << ' ' << right << ": " << error.what() << '\n';
    }
    return false;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 2 || (argc - 2) % 3 != 0)
    {
        std::cout << "usage: check_report REPORT [LEFT OP RIGHT]...\n";
        return 2;
    }
    std::ifstream file(argv[1]);
    const Json report = Json::parse(file, nullptr, false);
    if (report.is_discarded())
    {
        std::cout << argv[1] << " can't be read as JSON\n";
        return 2;
    }
    bool all_hold = true;
    for (int i = 2; i < argc; i += 3)
    {
        all_hold = compare(report, argv[i], argv[i + 1], argv[i + 2]) && all_hold;
    }
    return all_hold ? 0 : 1;
}
