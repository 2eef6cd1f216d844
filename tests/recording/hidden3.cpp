// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hiding.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_hiding("hidden3/boxes", some_boxes<3>(3, 2, 60), 2);
    record_hiding("hidden3/bisected", refined(kuhn<3>(3), 7, 1500), 1);
    record_hiding("hidden3/red", refined(kuhn<3>(0), 9, 150), 1);
    return finish(count, arguments);
}
