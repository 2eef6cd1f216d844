// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// A name as the value of an attribute in XML, with its quotation marks.
inline std::string xml_value(const std::string& name) {
    std::string result;
    for (const char c : name) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return "\"" + result + "\"";
}
