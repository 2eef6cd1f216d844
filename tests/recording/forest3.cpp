// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "forests.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    const auto boxes3 = some_boxes<3>(3, 2, 60);
    record_all("forest3/boxes", boxes3, subjects_on(boxes3, 2));
    const auto bisected = refined(kuhn<3>(3), 7, 900);
    record_options("forest3/bisected", bisected, subjects_on(bisected));
    record_threads("forest3/bisected", bisected, subjects_on(bisected));
    const auto red = refined(kuhn<3>(0), 9, 120);
    record_options("forest3/red", red, subjects_on(red));
    return finish(count, arguments);
}
