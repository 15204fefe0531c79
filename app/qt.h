/// \file
/// The Qt headers of the application, precompiled: they cost seconds a file otherwise.
#pragma once

#include <QtCore>
#include <QtWidgets>
