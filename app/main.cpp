#include "app/commands/editor.h"
#include "app/view/viewport.h"

#include <QApplication>

int main(int argc, char** argv) {
  QApplication application(argc, argv);
  cagewright::app::Document document;
  cagewright::app::Editor editor(document);
  cagewright::app::Viewport viewport(editor);
  viewport.show();
  return QApplication::exec();
}
