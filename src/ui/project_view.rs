//! How the person looks at the document, kept in its project and put on again when it is opened.

use super::{Editor, Request, Shading, Tool};
use crate::io::ProjectView;
use crate::mesh::VertexId;

/// The tools by the names that files have for them.
const TOOLS: [(Tool, &str); 3] = [(Tool::Select, "select"), (Tool::Fix, "fix"), (Tool::Constrain, "constrain")];

impl Editor {
    /// How the person looks at it now.
    pub(super) fn view(&self) -> ProjectView {
        let tool = TOOLS.iter().find(|(tool, _)| *tool == self.tool).map(|(_, name)| (*name).to_owned());
        let shading = Some(self.shading.title().to_owned());
        ProjectView {
            mesh_shading: shading.clone(),
            plane_shading: shading,
            selection: self.selection.iter().map(|vertex| vertex.number()).collect(),
            tool,
            ..ProjectView::default()
        }
    }

    /// Puts on how the person looked at what was opened. Call once its mesh is drawn.
    pub(super) fn put_on_view(&mut self) {
        let view = self.session.view().clone();
        let shading = view.mesh_shading.and_then(|name| Shading::ALL.into_iter().find(|s| s.title() == name));
        if let Some(shading) = shading {
            self.shading = shading;
        }
        if let Some((tool, _)) = TOOLS.into_iter().find(|(_, name)| view.tool.as_deref() == Some(*name)) {
            self.handle(Request::SetTool(tool));
        }
        let count = self.session.model().map_or(0, |model| model.mesh().vertex_count());
        let there = view.selection.into_iter().map(VertexId::new).filter(|vertex| vertex.index() < count);
        self.selection = there.collect();
    }
}
