<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
 <context>
  <name>QObject</name>
  <message>
   <source>Tool Axis</source>
   <translation>Tool Axis</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis</name>
  <message>
   <source> and {} more</source>
   <translation> und {} weitere</translation>
  </message>
  <message>
   <source>(stale)</source>
   <translation>(überholt)</translation>
  </message>
  <message>
   <source>, about {} s left</source>
   <translation>, noch etwa {} s</translation>
  </message>
  <message>
   <source>, missed by {}</source>
   <translation>, verfehlt um {}</translation>
  </message>
  <message>
   <source>A ball end goes around a blade in layers, one rotary axis swings. Needs a ball end; of the faces around a blade one is enough.</source>
   <translation>Ein Kugelfräser läuft in Schichten um eine Schaufel, eine Drehachse schwenkt. Braucht einen Kugelfräser; von den Flächen um eine Schaufel genügt eine.</translation>
  </message>
  <message>
   <source>A body to avoid was deleted: compute again without it</source>
   <translation>Ein zu meidender Körper wurde gelöscht: ohne ihn erneut berechnen</translation>
  </message>
  <message>
   <source>Against the best axis: {:+d} passes, {:+.1f} % cutting length, {:+.1f} % strip width.</source>
   <translation>Gegenüber der besten Achse: {:+d} Bahnen, {:+.1f} % Schnittlänge, {:+.1f} % Streifenbreite.</translation>
  </message>
  <message>
   <source>All operations use a moving tool axis. Choose their machine in the planning panel, tab Job.</source>
   <translation>Bei allen Operationen bewegt sich die Werkzeugachse beim Fräsen. Die Maschine in der Planung auf dem Reiter Auftrag wählen.</translation>
  </message>
  <message>
   <source>All tool axes can be reached. Axis travels not checked: the tool has no holder.</source>
   <translation>Alle Werkzeugachsen sind erreichbar. Verfahrwege nicht geprüft: Das Werkzeug hat keinen Halter.</translation>
  </message>
  <message>
   <source>All tool axes can be reached. OK puts the machine into the document.</source>
   <translation>Alle Werkzeugachsen sind erreichbar. OK übernimmt die Maschine in das Dokument.</translation>
  </message>
  <message>
   <source>Any number of tools</source>
   <translation>Beliebig viele Werkzeuge</translation>
  </message>
  <message>
   <source>Area</source>
   <translation>Fläche</translation>
  </message>
  <message>
   <source>Axis that turns</source>
   <translation>Achse, die dreht</translation>
  </message>
  <message>
   <source>Back</source>
   <translation>Zurück</translation>
  </message>
  <message>
   <source>Ball end D{}</source>
   <translation>Kugelfräser D{}</translation>
  </message>
  <message>
   <source>Between the passes {}</source>
   <translation>Zwischen den Bahnen: {}</translation>
  </message>
  <message>
   <source>Blade {}</source>
   <translation>Schaufel {}</translation>
  </message>
  <message>
   <source>Bull nose D{}, R{}</source>
   <translation>Torusfräser D{}, R{}</translation>
  </message>
  <message>
   <source>Cancel</source>
   <translation>Abbrechen</translation>
  </message>
  <message>
   <source>Change of tool, and index move to {}</source>
   <translation>Werkzeugwechsel, und Schwenkbewegung zu {}</translation>
  </message>
  <message>
   <source>Clean-up {}</source>
   <translation>Restmaterial {}</translation>
  </message>
  <message>
   <source>Click a point: the plan is computed again with that many axes.</source>
   <translation>Ein Klick auf einen Punkt: der Plan wird mit so vielen Achsen neu berechnet.</translation>
  </message>
  <message>
   <source>Click on the map to try an axis.</source>
   <translation>Ein Klick in die Karte probiert eine Achse aus.</translation>
  </message>
  <message>
   <source>Collision: {}; {} mm deep</source>
   <translation>Kollision: {}; {} mm tief</translation>
  </message>
  <message>
   <source>Collisions could not be looked for: {}</source>
   <translation>Nach Kollisionen konnte nicht gesucht werden: {}</translation>
  </message>
  <message>
   <source>Collisions: {} ({}).</source>
   <translation>Kollisionen: {} ({}).</translation>
  </message>
  <message>
   <source>Compute again</source>
   <translation>Neu berechnen</translation>
  </message>
  <message>
   <source>Copy details</source>
   <translation>Einzelheiten kopieren</translation>
  </message>
  <message>
   <source>Copy of {}</source>
   <translation>Kopie von {}</translation>
  </message>
  <message>
   <source>Cutter clearance</source>
   <translation>Abstand des Fräsers</translation>
  </message>
  <message>
   <source>Cutting length</source>
   <translation>Schnittlänge</translation>
  </message>
  <message>
   <source>Deepest gouge</source>
   <translation>Tiefste Konturverletzung</translation>
  </message>
  <message>
   <source>Diameter</source>
   <translation>Durchmesser</translation>
  </message>
  <message>
   <source>Different axes: {}; sub-surfaces: {}; {}</source>
   <translation>Verschiedene Achsen: {}; Teilflächen: {}; {}</translation>
  </message>
  <message>
   <source>Divide into sub-surfaces</source>
   <translation>In Teilflächen teilen</translation>
  </message>
  <message>
   <source>Drawing</source>
   <translation>Bilder werden gezeichnet</translation>
  </message>
  <message>
   <source>Elsewhere on the passes {}: {}</source>
   <translation>An anderer Stelle der Bahnen: {} ({})</translation>
  </message>
  <message>
   <source>Estimate and count</source>
   <translation>Schätzung und Zählung</translation>
  </message>
  <message>
   <source>Every face has an axis, but two-point contact was not possible anywhere (reasons: tab Axis). OK puts them into the document.</source>
   <translation>Jede Fläche hat eine Achse, aber Zwei-Punkt-Kontakt war nirgends möglich (Gründe: Reiter Achse). OK übernimmt sie in das Dokument.</translation>
  </message>
  <message>
   <source>Every face has an axis. {} OK puts them into the document.</source>
   <translation>Jede Fläche hat eine Achse. {} OK übernimmt sie in das Dokument.</translation>
  </message>
  <message>
   <source>Excess over ideal length</source>
   <translation>Mehrlänge gegenüber Ideal</translation>
  </message>
  <message>
   <source>Export</source>
   <translation>Exportieren</translation>
  </message>
  <message>
   <source>Face {}</source>
   <translation>Fläche {}</translation>
  </message>
  <message>
   <source>Face {} (turned copy)</source>
   <translation>Fläche {} (gedrehte Kopie)</translation>
  </message>
  <message>
   <source>Finishing {}</source>
   <translation>Schlichten {}</translation>
  </message>
  <message>
   <source>Fixed axes</source>
   <translation>Feste Achsen</translation>
  </message>
  <message>
   <source>Folder</source>
   <translation>Ordner</translation>
  </message>
  <message>
   <source>Folder for the pictures</source>
   <translation>Ordner für die Bilder</translation>
  </message>
  <message>
   <source>FreeCAD has mixed up this panel with one that was closed: open it once more, or start FreeCAD anew</source>
   <translation>FreeCAD hat dieses Fenster mit einem geschlossenen verwechselt: bitte noch einmal öffnen oder FreeCAD neu starten</translation>
  </message>
  <message>
   <source>FreeCAD's library {}</source>
   <translation>Bibliothek {} von FreeCAD</translation>
  </message>
  <message>
   <source>Give a folder.</source>
   <translation>Bitte einen Ordner angeben.</translation>
  </message>
  <message>
   <source>Gouge allowed</source>
   <translation>Erlaubte Konturverletzung</translation>
  </message>
  <message>
   <source>Gouge, at most</source>
   <translation>Konturverletzung, höchstens</translation>
  </message>
  <message>
   <source>HTML report: needs {}</source>
   <translation>HTML-Bericht: braucht {}</translation>
  </message>
  <message>
   <source>Height</source>
   <translation>Höhe</translation>
  </message>
  <message>
   <source>Highest scallop</source>
   <translation>Höchste Rille</translation>
  </message>
  <message>
   <source>Holder clearance</source>
   <translation>Abstand des Halters</translation>
  </message>
  <message>
   <source>Index move to {}</source>
   <translation>Schwenkbewegung zu {}</translation>
  </message>
  <message>
   <source>Inside tolerance</source>
   <translation>Innerhalb der Toleranz</translation>
  </message>
  <message>
   <source>Install {} by the Addon Manager for reports.</source>
   <translation>Für Berichte {} mit dem Addon-Manager installieren.</translation>
  </message>
  <message>
   <source>Job {}</source>
   <translation>Auftrag {}</translation>
  </message>
  <message>
   <source>Keeps to the roughness and strip width with the least rotary motion. Needs a bull nose and a machine (tab Job).</source>
   <translation>Hält Rauheit und Streifenbreite mit möglichst wenig Drehachsbewegung ein. Braucht einen Torusfräser und eine Maschine (Reiter Auftrag).</translation>
  </message>
  <message>
   <source>Largest for</source>
   <translation>Größtes auf</translation>
  </message>
  <message>
   <source>Lean from the normal, mean</source>
   <translation>Neigung zur Normalen, Mittel</translation>
  </message>
  <message>
   <source>Left to clean-up</source>
   <translation>Restmaterial</translation>
  </message>
  <message>
   <source>Length against the number of orientations</source>
   <translation>Länge über der Anzahl der Orientierungen</translation>
  </message>
  <message>
   <source>Length and number of axes</source>
   <translation>Länge und Zahl der Achsen</translation>
  </message>
  <message>
   <source>Looking at all operations</source>
   <translation>Alle Operationen werden betrachtet</translation>
  </message>
  <message>
   <source>Looking for collisions</source>
   <translation>Kollisionen werden gesucht</translation>
  </message>
  <message>
   <source>Machine</source>
   <translation>Maschine</translation>
  </message>
  <message>
   <source>Machine file</source>
   <translation>Maschinendatei</translation>
  </message>
  <message>
   <source>Machine {}</source>
   <translation>Maschine {}</translation>
  </message>
  <message>
   <source>Machined</source>
   <translation>Bearbeitet</translation>
  </message>
  <message>
   <source>Machining time</source>
   <translation>Bearbeitungszeit</translation>
  </message>
  <message>
   <source>Make CAM jobs</source>
   <translation>CAM-Aufträge anlegen</translation>
  </message>
  <message>
   <source>Making CAM jobs</source>
   <translation>CAM-Aufträge werden angelegt</translation>
  </message>
  <message>
   <source>Map of the tool axes</source>
   <translation>Karte der Werkzeugachsen</translation>
  </message>
  <message>
   <source>Motion of the axes</source>
   <translation>Bewegung der Achsen</translation>
  </message>
  <message>
   <source>No axis is free.</source>
   <translation>Keine Achse ist frei.</translation>
  </message>
  <message>
   <source>No collisions along the passes (checked: {})</source>
   <translation>Keine Kollisionen entlang der Bahnen (geprüft: {})</translation>
  </message>
  <message>
   <source>No collisions found.</source>
   <translation>Keine Kollisionen gefunden.</translation>
  </message>
  <message>
   <source>No map was kept of the axes that were looked at: the reasons stand below.</source>
   <translation>Von den betrachteten Achsen wurde keine Karte behalten: die Gründe stehen darunter.</translation>
  </message>
  <message>
   <source>No map: no axis was looked at.</source>
   <translation>Keine Karte: Es wurde keine Achse betrachtet.</translation>
  </message>
  <message>
   <source>No map: the axis moves along the passes.</source>
   <translation>Keine Karte: Die Achse bewegt sich entlang der Bahnen.</translation>
  </message>
  <message>
   <source>No map: this axis was not looked for by itself. It is shared by sub-surfaces, given, or named by the method.</source>
   <translation>Keine Karte: Diese Achse wurde nicht für sich gesucht. Teilflächen haben sie gemeinsam, sie ist vorgegeben oder folgt aus dem Verfahren.</translation>
  </message>
  <message>
   <source>No usable position on this machine: {}</source>
   <translation>Auf dieser Maschine keine brauchbare Stellung: {}</translation>
  </message>
  <message>
   <source>No vertex is selected: select a vertex of the part in the 3D view</source>
   <translation>Kein Punkt ist ausgewählt: in der 3D-Ansicht einen Punkt des Teils auswählen</translation>
  </message>
  <message>
   <source>Not checked: {}.</source>
   <translation>Nicht geprüft: {}.</translation>
  </message>
  <message>
   <source>Not in the jobs (no tool axis): {}</source>
   <translation>Nicht in den Aufträgen (keine Werkzeugachse): {}</translation>
  </message>
  <message>
   <source>Not inside tolerance: {}</source>
   <translation>Nicht innerhalb der Toleranz: {}</translation>
  </message>
  <message>
   <source>Nothing is selected: select faces or a body in the 3D view first</source>
   <translation>Nichts ist ausgewählt: bitte zuerst Flächen oder einen Körper in der 3D-Ansicht auswählen</translation>
  </message>
  <message>
   <source>On the machine</source>
   <translation>Auf der Maschine</translation>
  </message>
  <message>
   <source>On the way from {} to {}: {}</source>
   <translation>Auf dem Weg von {} nach {}: {}</translation>
  </message>
  <message>
   <source>On {}</source>
   <translation>Auf {}</translation>
  </message>
  <message>
   <source>One rotary axis is clamped, the other rotates along the passes. Needs a machine (tab Job).</source>
   <translation>Eine Drehachse ist geklemmt, die andere dreht entlang der Bahnen. Braucht eine Maschine (Reiter Auftrag).</translation>
  </message>
  <message>
   <source>Operations: {}. plan.json and their CL files are written.</source>
   <translation>Operationen: {}. plan.json und ihre CL-Dateien werden geschrieben.</translation>
  </message>
  <message>
   <source>Orientation {}</source>
   <translation>Orientierung {}</translation>
  </message>
  <message>
   <source>Orientations</source>
   <translation>Orientierungen</translation>
  </message>
  <message>
   <source>Other methods</source>
   <translation>Andere Verfahren</translation>
  </message>
  <message>
   <source>Outcome</source>
   <translation>Ergebnis</translation>
  </message>
  <message>
   <source>Passes</source>
   <translation>Bahnen</translation>
  </message>
  <message>
   <source>Passes and tool</source>
   <translation>Bahnen und Werkzeug</translation>
  </message>
  <message>
   <source>Passes {}</source>
   <translation>Bahnen {}</translation>
  </message>
  <message>
   <source>Pause</source>
   <translation>Pause</translation>
  </message>
  <message>
   <source>Pictures of the plan</source>
   <translation>Bilder des Plans</translation>
  </message>
  <message>
   <source>Plan</source>
   <translation>Plan</translation>
  </message>
  <message>
   <source>Plan again for {}</source>
   <translation>Für {} neu planen</translation>
  </message>
  <message>
   <source>Plan orientations</source>
   <translation>Orientierungen planen</translation>
  </message>
  <message>
   <source>Play</source>
   <translation>Abspielen</translation>
  </message>
  <message>
   <source>Points: the largest tool that was found to reach the face there, grey where none was found so far; an estimate. Lines: finished passes.</source>
   <translation>Punkte: das größte Werkzeug, für das die Fläche dort erreichbar scheint, grau, wo bisher keines gefunden wurde; eine Schätzung. Linien: fertige Bahnen.</translation>
  </message>
  <message>
   <source>Press Compute to find the axes.</source>
   <translation>Berechnen findet die Achsen.</translation>
  </message>
  <message>
   <source>Raise the part by {}</source>
   <translation>Teil um {} höher setzen</translation>
  </message>
  <message>
   <source>Reading the part</source>
   <translation>Das Teil wird gelesen</translation>
  </message>
  <message>
   <source>Reading the passes</source>
   <translation>Die Bahnen werden gelesen</translation>
  </message>
  <message>
   <source>Removing material</source>
   <translation>Material wird abgetragen</translation>
  </message>
  <message>
   <source>Results are up to date; verdict: {}</source>
   <translation>Die Ergebnisse sind aktuell; Urteil: {}</translation>
  </message>
  <message>
   <source>Roman's rule</source>
   <translation>Regel von Roman</translation>
  </message>
  <message>
   <source>Save all...</source>
   <translation>Alle speichern...</translation>
  </message>
  <message>
   <source>Scallop height {}</source>
   <translation>Rillenhöhe {}</translation>
  </message>
  <message>
   <source>Scallop limit</source>
   <translation>Grenze der Rillenhöhe</translation>
  </message>
  <message>
   <source>Select a vertex of the part in the 3D view and press Use selected on the tab Setup</source>
   <translation>In der 3D-Ansicht einen Punkt des Teils auswählen und auf der Seite Aufspannung „Auswahl nehmen“ drücken</translation>
  </message>
  <message>
   <source>Select one or more faces in the 3D view and press Add selected</source>
   <translation>Bitte eine oder mehrere Flächen in der 3D-Ansicht auswählen und Auswahl hinzufügen drücken</translation>
  </message>
  <message>
   <source>Select one sub-surface in the tree, and one line that cuts it if it shall not be cut in the middle.</source>
   <translation>Bitte eine Teilfläche im Baum auswählen, und eine Linie, die sie zerteilt, wenn es nicht in der Mitte sein soll.</translation>
  </message>
  <message>
   <source>Select two or more sub-surfaces of one face in the tree first.</source>
   <translation>Bitte zuerst zwei oder mehr Teilflächen einer Fläche im Baum auswählen.</translation>
  </message>
  <message>
   <source>Shank clearance</source>
   <translation>Abstand des Schafts</translation>
  </message>
  <message>
   <source>Solution {}</source>
   <translation>Lösung {}</translation>
  </message>
  <message>
   <source>Something has changed: compute again.</source>
   <translation>Etwas hat sich geändert: bitte neu berechnen.</translation>
  </message>
  <message>
   <source>Stale: {}. Compute again</source>
   <translation>Überholt: {}. Neu berechnen</translation>
  </message>
  <message>
   <source>Stick-out {}</source>
   <translation>Auskraglänge {}</translation>
  </message>
  <message>
   <source>Stock: {}</source>
   <translation>Rohteil: {}</translation>
  </message>
  <message>
   <source>Stopped</source>
   <translation>Gestoppt</translation>
  </message>
  <message>
   <source>Stopped before the first face had passes.</source>
   <translation>Gestoppt, bevor die erste Fläche Bahnen hatte.</translation>
  </message>
  <message>
   <source>Stopped with {} finished. {} OK puts what is finished into the document.</source>
   <translation>Gestoppt, fertig: {}. {} OK übernimmt das Fertige in das Dokument.</translation>
  </message>
  <message>
   <source>Stopped. {} OK puts what is finished into the document.</source>
   <translation>Gestoppt. {} OK übernimmt das Fertige in das Dokument.</translation>
  </message>
  <message>
   <source>Stopped; the document is unchanged.</source>
   <translation>Gestoppt; das Dokument ist unverändert.</translation>
  </message>
  <message>
   <source>Stopped; the folder is as it was.</source>
   <translation>Gestoppt; der Ordner ist wie zuvor.</translation>
  </message>
  <message>
   <source>Stopping</source>
   <translation>Wird gestoppt</translation>
  </message>
  <message>
   <source>Strip width</source>
   <translation>Streifenbreite</translation>
  </message>
  <message>
   <source>Strip width and roughness</source>
   <translation>Streifenbreite und Rauheit</translation>
  </message>
  <message>
   <source>Strip widths</source>
   <translation>Streifenbreiten</translation>
  </message>
  <message>
   <source>Sub-surface {}</source>
   <translation>Teilfläche {}</translation>
  </message>
  <message>
   <source>The axis leans by one angle from the normal, along the feed.</source>
   <translation>Die Achse neigt sich um einen Winkel von der Normalen in Vorschubrichtung.</translation>
  </message>
  <message>
   <source>The axis moves along the passes: lines in the 3D view show it.</source>
   <translation>Die Achse bewegt sich längs der Bahnen: Linien in der 3D-Ansicht zeigen sie.</translation>
  </message>
  <message>
   <source>The cutter touches the face at two points where that is hollow. Needs a flat end or bull nose.</source>
   <translation>Der Fräser berührt die Fläche an zwei Punkten, wo sie hohl ist. Braucht einen Schaft- oder Torusfräser.</translation>
  </message>
  <message>
   <source>The document was not changed. Please report the error with the copied details and, if you can, the part.</source>
   <translation>Das Dokument wurde nicht verändert. Bitte melden Sie den Fehler mit den kopierten Einzelheiten und, wenn möglich, dem Teil.</translation>
  </message>
  <message>
   <source>The machine is not shown: {}</source>
   <translation>Die Maschine wird nicht gezeigt: {}</translation>
  </message>
  <message>
   <source>The map could not be drawn.</source>
   <translation>Die Karte konnte nicht gezeichnet werden.</translation>
  </message>
  <message>
   <source>The map is being drawn.</source>
   <translation>Die Karte wird gezeichnet.</translation>
  </message>
  <message>
   <source>The map of the tool axes appears here after Compute.</source>
   <translation>Nach dem Berechnen erscheint hier die Karte der Werkzeugachsen.</translation>
  </message>
  <message>
   <source>The operation was deleted</source>
   <translation>Die Operation wurde gelöscht</translation>
  </message>
  <message>
   <source>The operations were deleted: there is no axis to hold</source>
   <translation>Die Operationen wurden gelöscht: es ist keine Achse zu halten</translation>
  </message>
  <message>
   <source>The operations were deleted: there is nothing to write</source>
   <translation>Die Operationen wurden gelöscht: es ist nichts zu schreiben</translation>
  </message>
  <message>
   <source>The part was deleted: select other faces</source>
   <translation>Das Teil wurde gelöscht: bitte andere Flächen auswählen</translation>
  </message>
  <message>
   <source>The pictures cannot be written: {}</source>
   <translation>Die Bilder können nicht geschrieben werden: {}</translation>
  </message>
  <message>
   <source>The tool alone: choose a machine with Tool Axis &gt; Machine to see it and its index moves</source>
   <translation>Nur das Werkzeug: mit Tool Axis &gt; Maschine eine Maschine wählen, um sie und ihre Schwenkbewegungen zu sehen</translation>
  </message>
  <message>
   <source>The verdict could not be kept: {}</source>
   <translation>Das Urteil konnte nicht aufbewahrt werden: {}</translation>
  </message>
  <message>
   <source>The vertex is not of the part that is machined: select one of {}</source>
   <translation>Der Punkt gehört nicht zum bearbeiteten Teil: einen von {} auswählen</translation>
  </message>
  <message>
   <source>There is no map.</source>
   <translation>Es gibt keine Karte.</translation>
  </message>
  <message>
   <source>There is no planned operation for a machine: select faces and run Plan Orientations first.</source>
   <translation>Es gibt keine geplante Operation für eine Maschine: bitte Flächen auswählen und zuerst Orientierungen planen.</translation>
  </message>
  <message>
   <source>There is no planned operation to make a job of: select faces and run Plan Orientations first.</source>
   <translation>Es gibt keine geplante Operation für einen Auftrag: bitte Flächen auswählen und zuerst Orientierungen planen.</translation>
  </message>
  <message>
   <source>There is no planned operation to play: select faces and run Plan Orientations first.</source>
   <translation>Es gibt keine geplante Operation zum Abspielen: zuerst Flächen auswählen und Orientierungen planen.</translation>
  </message>
  <message>
   <source>There is no planned operation to recompute: select faces and run Plan Orientations first.</source>
   <translation>Es gibt keine geplante Operation, die neu zu berechnen wäre: bitte Flächen auswählen und zuerst Orientierungen planen.</translation>
  </message>
  <message>
   <source>There is no planned operation to verify: select faces and run Plan Orientations first.</source>
   <translation>Es gibt keine geplante Operation, die zu prüfen wäre: bitte Flächen auswählen und zuerst Orientierungen planen.</translation>
  </message>
  <message>
   <source>There is no planned operation to write: select faces and run Plan Orientations first.</source>
   <translation>Es gibt keine geplante Operation, die zu schreiben wäre: bitte Flächen auswählen und zuerst Orientierungen planen.</translation>
  </message>
  <message>
   <source>These operations have {0} orientations, and each becomes a job. There are only {1} work offsets (G54 to G59.3), so some jobs will share one. Make {0} jobs?</source>
   <translation>Diese Operationen haben {0} Orientierungen, und jede wird ein Auftrag. Es gibt nur {1} Nullpunktverschiebungen (G54 bis G59.3), deshalb teilen sich manche Aufträge eine. {0} Aufträge anlegen?</translation>
  </message>
  <message>
   <source>This axis can be used.</source>
   <translation>Diese Achse ist brauchbar.</translation>
  </message>
  <message>
   <source>This axis cannot be used.</source>
   <translation>Diese Achse ist nicht brauchbar.</translation>
  </message>
  <message>
   <source>Tilt from Z</source>
   <translation>Neigung gegen Z</translation>
  </message>
  <message>
   <source>Time</source>
   <translation>Zeit</translation>
  </message>
  <message>
   <source>Tolerance {}</source>
   <translation>Toleranz {}</translation>
  </message>
  <message>
   <source>Tool</source>
   <translation>Werkzeug</translation>
  </message>
  <message>
   <source>Tool Axis loads its libraries in the background</source>
   <translation>Tool Axis lädt seine Bibliotheken im Hintergrund</translation>
  </message>
  <message>
   <source>Tool Axis: tour and manual</source>
   <translation>Tool Axis: Rundgang und Handbuch</translation>
  </message>
  <message>
   <source>Tool Axis: {}; tool axis {} in the document</source>
   <translation>Tool Axis: {}; Werkzeugachse {} im Dokument</translation>
  </message>
  <message>
   <source>Tool angles in the S-theta plane</source>
   <translation>Werkzeugwinkel in der S-Theta-Ebene</translation>
  </message>
  <message>
   <source>Tool axes</source>
   <translation>Werkzeugachsen</translation>
  </message>
  <message>
   <source>Tool axes {}</source>
   <translation>Werkzeugachsen {}</translation>
  </message>
  <message>
   <source>Tool libraries ({})</source>
   <translation>Werkzeugbibliotheken ({})</translation>
  </message>
  <message>
   <source>Tool {}</source>
   <translation>Werkzeug {}</translation>
  </message>
  <message>
   <source>Tools</source>
   <translation>Werkzeuge</translation>
  </message>
  <message>
   <source>Tried</source>
   <translation>Ausprobiert</translation>
  </message>
  <message>
   <source>Trying this axis...</source>
   <translation>Diese Achse wird ausprobiert...</translation>
  </message>
  <message>
   <source>Trying this axis: {}...</source>
   <translation>Diese Achse wird ausprobiert: {}...</translation>
  </message>
  <message>
   <source>Turn about Z</source>
   <translation>Drehung um Z</translation>
  </message>
  <message>
   <source>Two contacts</source>
   <translation>Zwei Berührungen</translation>
  </message>
  <message>
   <source>Use the general rack</source>
   <translation>Allgemeines Magazin nehmen</translation>
  </message>
  <message>
   <source>Verify</source>
   <translation>Prüfen</translation>
  </message>
  <message>
   <source>Where it is tightest</source>
   <translation>Wo es am engsten ist</translation>
  </message>
  <message>
   <source>Whole part</source>
   <translation>Ganzes Teil</translation>
  </message>
  <message>
   <source>Within {} (rest material excluded)</source>
   <translation>Innerhalb {} (ohne Restmaterial)</translation>
  </message>
  <message>
   <source>Without limits</source>
   <translation>Ohne Grenzen</translation>
  </message>
  <message>
   <source>Work coordinates {}</source>
   <translation>Werkstückkoordinaten {}</translation>
  </message>
  <message>
   <source>above {}</source>
   <translation>über {}</translation>
  </message>
  <message>
   <source>axes: {}</source>
   <translation>Achsen: {}</translation>
  </message>
  <message>
   <source>axis tried</source>
   <translation>ausprobierte Achse</translation>
  </message>
  <message>
   <source>bodies of the machine</source>
   <translation>Körper der Maschine</translation>
  </message>
  <message>
   <source>cancelled</source>
   <translation>abgebrochen</translation>
  </message>
  <message>
   <source>changes of tool and axis</source>
   <translation>Wechsel von Werkzeug und Achse</translation>
  </message>
  <message>
   <source>checking for gouges and collisions</source>
   <translation>Konturverletzungen und Kollisionen werden geprüft</translation>
  </message>
  <message>
   <source>chosen axis</source>
   <translation>gewählte Achse</translation>
  </message>
  <message>
   <source>chosen axis: strip width {}, {} passes as made</source>
   <translation>gewählte Achse: Streifenbreite {}, {} Bahnen wie erzeugt</translation>
  </message>
  <message>
   <source>different axes</source>
   <translation>verschiedene Achsen</translation>
  </message>
  <message>
   <source>drawing the map</source>
   <translation>die Karte wird gezeichnet</translation>
  </message>
  <message>
   <source>estimate: strip width {}, {:.0f} passes, {}</source>
   <translation>Schätzung: Streifenbreite {}, {:.0f} Bahnen, {}</translation>
  </message>
  <message>
   <source>far</source>
   <translation>weit</translation>
  </message>
  <message>
   <source>feasible</source>
   <translation>machbar</translation>
  </message>
  <message>
   <source>folder of tools...</source>
   <translation>Ordner mit Werkzeugen...</translation>
  </message>
  <message>
   <source>forbidden: {}{}, {}</source>
   <translation>verboten: {}{}, {}</translation>
  </message>
  <message>
   <source>general rack</source>
   <translation>allgemeines Magazin</translation>
  </message>
  <message>
   <source>holder</source>
   <translation>Halter</translation>
  </message>
  <message>
   <source>index moves</source>
   <translation>Schwenkbewegungen</translation>
  </message>
  <message>
   <source>infeasible (proven)</source>
   <translation>unmöglich (bewiesen)</translation>
  </message>
  <message>
   <source>left to clean-up</source>
   <translation>Restmaterial</translation>
  </message>
  <message>
   <source>library file...</source>
   <translation>Bibliotheksdatei...</translation>
  </message>
  <message>
   <source>making passes</source>
   <translation>Bahnen werden gemacht</translation>
  </message>
  <message>
   <source>mean normal</source>
   <translation>mittlere Normale</translation>
  </message>
  <message>
   <source>mean step-over {}</source>
   <translation>mittlerer Bahnabstand {}</translation>
  </message>
  <message>
   <source>no other body in the document</source>
   <translation>kein anderer Körper im Dokument</translation>
  </message>
  <message>
   <source>no position reaches it</source>
   <translation>keine Stellung erreicht sie</translation>
  </message>
  <message>
   <source>none</source>
   <translation>keines</translation>
  </message>
  <message>
   <source>none found</source>
   <translation>keine gefunden</translation>
  </message>
  <message>
   <source>not checked</source>
   <translation>nicht geprüft</translation>
  </message>
  <message>
   <source>not reached</source>
   <translation>nicht erreicht</translation>
  </message>
  <message>
   <source>one tool (tab Tool)</source>
   <translation>ein Werkzeug (Reiter Werkzeug)</translation>
  </message>
  <message>
   <source>optimal (proven)</source>
   <translation>optimal (bewiesen)</translation>
  </message>
  <message>
   <source>other good axes</source>
   <translation>andere gute Achsen</translation>
  </message>
  <message>
   <source>over {}</source>
   <translation>über {}</translation>
  </message>
  <message>
   <source>passes: {}</source>
   <translation>Bahnen: {}</translation>
  </message>
  <message>
   <source>screening</source>
   <translation>Vorauswahl</translation>
  </message>
  <message>
   <source>shank</source>
   <translation>Schaft</translation>
  </message>
  <message>
   <source>show it</source>
   <translation>zeigen</translation>
  </message>
  <message>
   <source>show the next one</source>
   <translation>die nächste zeigen</translation>
  </message>
  <message>
   <source>skins: {} of {} faces, {}</source>
   <translation>Häute: {} aus {} Flächen, {}</translation>
  </message>
  <message>
   <source>strip width, estimated</source>
   <translation>Streifenbreite, geschätzt</translation>
  </message>
  <message>
   <source>total</source>
   <translation>gesamt</translation>
  </message>
  <message>
   <source>typed in below</source>
   <translation>unten eingegeben</translation>
  </message>
  <message>
   <source>{:.0f} s</source>
   <translation>{:.0f} s</translation>
  </message>
  <message>
   <source>{:.0f}° from the mean normal</source>
   <translation>{:.0f}° von der mittleren Normalen</translation>
  </message>
  <message>
   <source>{} (locked)</source>
   <translation>{} (gesperrt)</translation>
  </message>
  <message>
   <source>{} (turned copy)</source>
   <translation>{} (gedrehte Kopie)</translation>
  </message>
  <message>
   <source>{} Collisions with the part could not be looked for: {}</source>
   <translation>{} Kollisionen mit dem Teil konnten nicht gesucht werden: {}</translation>
  </message>
  <message>
   <source>{} OK puts the plan into the document.</source>
   <translation>{} OK übernimmt den Plan in das Dokument.</translation>
  </message>
  <message>
   <source>{} The reasons are on the tab Axis.</source>
   <translation>{} Die Gründe stehen auf dem Reiter Achse.</translation>
  </message>
  <message>
   <source>{} and {} more</source>
   <translation>{} und {} weitere</translation>
  </message>
  <message>
   <source>{} at ({}, {}, {}) on face {}</source>
   <translation>{} bei ({}, {}, {}) auf Fläche {}</translation>
  </message>
  <message>
   <source>{} files in {}</source>
   <translation>{} Dateien in {}</translation>
  </message>
  <message>
   <source>{} h</source>
   <translation>{} h</translation>
  </message>
  <message>
   <source>{} is also the work offset of {}: set it for this orientation before the program runs</source>
   <translation>{} ist auch die Nullpunktverschiebung von {}: vor dem Programm für diese Orientierung einstellen</translation>
  </message>
  <message>
   <source>{} is only {} across: check the unit of its file.</source>
   <translation>{} misst nur {}: die Einheit der Datei prüfen.</translation>
  </message>
  <message>
   <source>{} is stale: {}. Compute it again.</source>
   <translation>{} ist überholt: {}. Bitte neu berechnen.</translation>
  </message>
  <message>
   <source>{} is {} across: check the unit of its file.</source>
   <translation>{} misst {}: die Einheit der Datei prüfen.</translation>
  </message>
  <message>
   <source>{} min</source>
   <translation>{} min</translation>
  </message>
  <message>
   <source>{} not begun</source>
   <translation>{} nicht begonnen</translation>
  </message>
  <message>
   <source>{} of {}</source>
   <translation>{} von {}</translation>
  </message>
  <message>
   <source>{} of {} faces have an axis, {} are left to a clean-up tool, {} have none; the reasons are on the tab Axis.</source>
   <translation>{} von {} Flächen haben eine Achse, {} bleiben als Restmaterial stehen, {} haben keine; die Gründe stehen auf dem Reiter Achse.</translation>
  </message>
  <message>
   <source>{} of {} faces have an axis, {} are left to a clean-up tool. {} OK puts them into the document.</source>
   <translation>{} von {} Flächen haben eine Achse, {} bleiben als Restmaterial stehen. {} OK übernimmt sie in das Dokument.</translation>
  </message>
  <message>
   <source>{} of {} faces have an axis; the reasons are on the tab Axis.</source>
   <translation>{} von {} Flächen haben eine Achse; die Gründe stehen auf dem Reiter Achse.</translation>
  </message>
  <message>
   <source>{} of {} jobs share their work offset with another job. Set the offset for the orientation before you run such a program. Jobs and programs carry a note.</source>
   <translation>{} von {} Aufträgen teilen sich die Nullpunktverschiebung mit einem anderen. Vor dem Start eines solchen Programms die Verschiebung für die Orientierung setzen. Aufträge und Programme tragen einen Hinweis.</translation>
  </message>
  <message>
   <source>{} of {} machined</source>
   <translation>{} von {} bearbeitet</translation>
  </message>
  <message>
   <source>{} of {} sub-surfaces</source>
   <translation>{} von {} Teilflächen</translation>
  </message>
  <message>
   <source>{} of {}: cutting {}, moves {}</source>
   <translation>{} von {}: Schnitt {}, Bewegungen {}</translation>
  </message>
  <message>
   <source>{} open</source>
   <translation>{} offen</translation>
  </message>
  <message>
   <source>{} parts</source>
   <translation>{} Teilen</translation>
  </message>
  <message>
   <source>{} proven out of reach</source>
   <translation>{} nachweislich unerreichbar</translation>
  </message>
  <message>
   <source>{} row {}: {} '{}' is not a length</source>
   <translation>{} Zeile {}: {} '{}' ist keine Länge</translation>
  </message>
  <message>
   <source>{} s</source>
   <translation>{} s</translation>
  </message>
  <message>
   <source>{} so far</source>
   <translation>seit {}</translation>
  </message>
  <message>
   <source>{} with {} of {} tools</source>
   <translation>{} mit {} von {} Werkzeugen</translation>
  </message>
  <message>
   <source>{}, about {} left</source>
   <translation>{}, noch etwa {}</translation>
  </message>
  <message>
   <source>{}, about {} left of this step</source>
   <translation>{}, in diesem Schritt noch etwa {}</translation>
  </message>
  <message>
   <source>{}, border aside</source>
   <translation>{}, ohne den Rand</translation>
  </message>
  <message>
   <source>{}, tiny and not listed: {}</source>
   <translation>{}, winzig und nicht gezeigt: {}</translation>
  </message>
  <message>
   <source>{}, {:.1f} % less than the first</source>
   <translation>{}, {:.1f} % weniger als beim ersten</translation>
  </message>
  <message>
   <source>{}. Assumed: {}.</source>
   <translation>{}. Angenommen: {}.</translation>
  </message>
  <message>
   <source>{}: cutting, pass {} of {}</source>
   <translation>{}: Schnitt, Bahn {} von {}</translation>
  </message>
  <message>
   <source>{}: lead-in, pass {} of {}</source>
   <translation>{}: Einlauf, Bahn {} von {}</translation>
  </message>
  <message>
   <source>{}: lead-out, pass {} of {}</source>
   <translation>{}: Auslauf, Bahn {} von {}</translation>
  </message>
  <message>
   <source>{}: left to clean-up</source>
   <translation>{}: Restmaterial</translation>
  </message>
  <message>
   <source>{}: link, pass {} of {}</source>
   <translation>{}: Verbindung, Bahn {} von {}</translation>
  </message>
  <message>
   <source>{}: no axis</source>
   <translation>{}: keine Achse</translation>
  </message>
  <message>
   <source>{}: no axis looked at yet</source>
   <translation>{}: noch keine Achse betrachtet</translation>
  </message>
  <message>
   <source>{}: not begun</source>
   <translation>{}: nicht begonnen</translation>
  </message>
  <message>
   <source>{}: the axes looked at so far</source>
   <translation>{}: die bisher betrachteten Achsen</translation>
  </message>
  <message>
   <source>{}: the largest tool that was found to reach, on {} of the area so far</source>
   <translation>{}: größtes einsetzbares Werkzeug auf {} der bisher geprüften Fläche</translation>
  </message>
  <message>
   <source>{}: {} operations</source>
   <translation>{}: {} Operationen</translation>
  </message>
 </context>
 <context>
  <name>ToolAxisExport</name>
  <message>
   <source>A program holds rotary angles, so it is written for one machine. The plan itself needs none.</source>
   <translation>Ein Programm enthält Winkel der Drehachsen und wird deshalb für eine Maschine geschrieben. Der Plan selbst braucht keine.</translation>
  </message>
  <message>
   <source>Chooses a folder.</source>
   <translation>Wählt einen Ordner.</translation>
  </message>
  <message>
   <source>Export</source>
   <translation>Exportieren</translation>
  </message>
  <message>
   <source>Folder</source>
   <translation>Ordner</translation>
  </message>
  <message>
   <source>Folder that the files are written into. Files of an earlier plan there are replaced, others stay.</source>
   <translation>Ordner, in den die Dateien geschrieben werden. Dateien eines früheren Plans dort werden ersetzt, andere bleiben.</translation>
  </message>
  <message>
   <source>HTML report</source>
   <translation>HTML-Bericht</translation>
  </message>
  <message>
   <source>Machine</source>
   <translation>Maschine</translation>
  </message>
  <message>
   <source>Machine that the program is for: its rotary angles stand in it.</source>
   <translation>Maschine, für die das Programm ist: ihre Drehwinkel stehen darin.</translation>
  </message>
  <message>
   <source>NC program besides plan.json and the CL files, with its setup sheet.</source>
   <translation>NC-Programm neben plan.json und den CL-Dateien, mit Einrichteblatt.</translation>
  </message>
  <message>
   <source>Opens the planning panel with this machine and place on its table, and computes: axes, passes and collisions are then those of the machine.</source>
   <translation>Öffnet das Planungsfenster mit dieser Maschine und diesem Platz auf ihrem Tisch und rechnet: Achsen, Bahnen und Kollisionen sind dann die der Maschine.</translation>
  </message>
  <message>
   <source>Origin on the table</source>
   <translation>Ursprung auf dem Tisch</translation>
  </message>
  <message>
   <source>Program</source>
   <translation>Programm</translation>
  </message>
  <message>
   <source>Sets the part higher on the table, in Z of its origin, and writes. It may help; only the new program tells.</source>
   <translation>Setzt das Teil auf dem Tisch höher, in Z seines Ursprungs, und schreibt. Das kann helfen; erst das neue Programm zeigt es.</translation>
  </message>
  <message>
   <source>Stop</source>
   <translation>Stopp</translation>
  </message>
  <message>
   <source>Stops; the folder stays as it is.</source>
   <translation>Hält an; der Ordner bleibt, wie er ist.</translation>
  </message>
  <message>
   <source>The dialect of the controller. The program is the one that the command toolaxis post writes.</source>
   <translation>Der Dialekt der Steuerung. Das Programm ist das, welches der Befehl toolaxis post schreibt.</translation>
  </message>
  <message>
   <source>The files that were written.</source>
   <translation>Die geschriebenen Dateien.</translation>
  </message>
  <message>
   <source>Write</source>
   <translation>Schreiben</translation>
  </message>
  <message>
   <source>Writes all files, or none.</source>
   <translation>Schreibt alle Dateien oder keine.</translation>
  </message>
  <message>
   <source>Writes the plan as one HTML page as well; that needs the Python package jinja2.</source>
   <translation>Schreibt den Plan auch als eine HTML-Seite; dazu braucht es das Python-Paket jinja2.</translation>
  </message>
  <message>
   <source>X of the document's origin in machine coordinates, all axes at zero, in mm.</source>
   <translation>X des Ursprungs des Dokuments in Maschinenkoordinaten, alle Achsen auf null, in mm.</translation>
  </message>
  <message>
   <source>Y of the document's origin in machine coordinates, all axes at zero, in mm.</source>
   <translation>Y des Ursprungs des Dokuments in Maschinenkoordinaten, alle Achsen auf null, in mm.</translation>
  </message>
  <message>
   <source>Z of the document's origin in machine coordinates, all axes at zero, in mm.</source>
   <translation>Z des Ursprungs des Dokuments in Maschinenkoordinaten, alle Achsen auf null, in mm.</translation>
  </message>
  <message>
   <source>…</source>
   <translation>…</translation>
  </message>
 </context>
 <context>
  <name>ToolAxisMachine</name>
  <message>
   <source>Collisions of cutter, shank, holder and machine with the part, clamps and each other, and gouges that Verify found.</source>
   <translation>Kollisionen von Fräser, Schaft, Halter und Maschine mit dem Teil, Spannmitteln und untereinander, und Konturverletzungen, die Prüfen fand.</translation>
  </message>
  <message>
   <source>How many times faster than the machine it is played.</source>
   <translation>Um wie viel schneller als auf der Maschine abgespielt wird.</translation>
  </message>
  <message>
   <source>Look from the machine's bed</source>
   <translation>Vom Maschinenbett aus betrachten</translation>
  </message>
  <message>
   <source>Machine</source>
   <translation>Maschine</translation>
  </message>
  <message>
   <source>Machines of the library, of the folder named in the preferences, and of FreeCAD.</source>
   <translation>Maschinen der Bibliothek, des in den Einstellungen genannten Ordners und von FreeCAD.</translation>
  </message>
  <message>
   <source>Moves the tool along the passes of all operations.</source>
   <translation>Bewegt das Werkzeug längs der Bahnen aller Operationen.</translation>
  </message>
  <message>
   <source>Opens a machine file: TOML, or one of FreeCAD (.fcm).</source>
   <translation>Öffnet eine Maschinendatei: TOML oder eine von FreeCAD (.fcm).</translation>
  </message>
  <message>
   <source>Origin on the table</source>
   <translation>Ursprung auf dem Tisch</translation>
  </message>
  <message>
   <source>Play</source>
   <translation>Abspielen</translation>
  </message>
  <message>
   <source>Plays all operations in their order, with the index moves between them.</source>
   <translation>Spielt alle Operationen in ihrer Reihenfolge ab, mit den Schwenkbewegungen dazwischen.</translation>
  </message>
  <message>
   <source>The camera stays with the machine's bed, so that the table turns; otherwise it stays with the part.</source>
   <translation>Die Kamera bleibt beim Maschinenbett, so dass sich der Tisch dreht; sonst bleibt sie beim Teil.</translation>
  </message>
  <message>
   <source>The machine whose rotary axes are to hold the tool axes. Its ranges, travels and bodies are looked at for every operation.</source>
   <translation>Die Maschine, deren Drehachsen die Werkzeugachsen halten sollen. Ihre Bereiche, Verfahrwege und Körper werden für jede Operation betrachtet.</translation>
  </message>
  <message>
   <source>Time so far and in all, and how it divides into cutting and all other moves: lead-ins, links, index moves and changes of tool.</source>
   <translation>Bisherige und gesamte Zeit, und wie sie sich auf Schnitt und alle anderen Bewegungen verteilt: Ein- und Auslauf, Verbindungen, Schwenkbewegungen und Werkzeugwechsel.</translation>
  </message>
  <message>
   <source>Two rotary axes reach almost every tool axis in two positions. The bold one is used: closest to the previous operation, inside all ranges and travels, and without collisions. Problems are listed below the angles.</source>
   <translation>Zwei Drehachsen erreichen fast jede Werkzeugachse in zwei Stellungen. Verwendet wird die fett gedruckte: der vorigen Operation am nächsten, innerhalb aller Bereiche und Verfahrwege und ohne Kollision. Probleme stehen unter den Winkeln.</translation>
  </message>
  <message>
   <source>Where the rotary axes stand for each operation, in both solutions. Click one to see it.</source>
   <translation>Wo die Drehachsen bei jeder Operation stehen, in beiden Lösungen. Ein Klick zeigt die Lösung.</translation>
  </message>
  <message>
   <source>X of the document's origin in machine coordinates, all axes at zero, in mm.</source>
   <translation>X des Ursprungs des Dokuments in Maschinenkoordinaten, alle Achsen auf null, in mm.</translation>
  </message>
  <message>
   <source>Y of the document's origin in machine coordinates, all axes at zero, in mm.</source>
   <translation>Y des Ursprungs des Dokuments in Maschinenkoordinaten, alle Achsen auf null, in mm.</translation>
  </message>
  <message>
   <source>Z of the document's origin in machine coordinates, all axes at zero, in mm.</source>
   <translation>Z des Ursprungs des Dokuments in Maschinenkoordinaten, alle Achsen auf null, in mm.</translation>
  </message>
  <message>
   <source>…</source>
   <translation>…</translation>
  </message>
 </context>
 <context>
  <name>ToolAxisOperation</name>
  <message>
   <source>Collisions of cutter, shank and holder with the part, the bodies to avoid and everything else visible, and where they are.</source>
   <translation>Kollisionen von Fräser, Schaft und Halter mit dem Teil, den zu meidenden Körpern und allem sonst Sichtbaren, und wo sie sind.</translation>
  </message>
  <message>
   <source>Moves tool and holder along the passes.</source>
   <translation>Bewegt Werkzeug und Halter entlang der Bahnen.</translation>
  </message>
  <message>
   <source>Opens the planning panel with the inputs of this operation.</source>
   <translation>Öffnet die Planung mit den Eingaben dieser Operation.</translation>
  </message>
  <message>
   <source>Operation</source>
   <translation>Operation</translation>
  </message>
  <message>
   <source>Pictures...</source>
   <translation>Bilder...</translation>
  </message>
  <message>
   <source>Plan again...</source>
   <translation>Neu planen...</translation>
  </message>
  <message>
   <source>Removes material along the passes.</source>
   <translation>Trägt entlang der Bahnen Material ab.</translation>
  </message>
  <message>
   <source>Shows pictures of the plan in a window: passes, contacts, angles and axis motion.</source>
   <translation>Zeigt Bilder des Plans in einem Fenster: Bahnen, Kontakte, Winkel und Achsbewegungen.</translation>
  </message>
  <message>
   <source>Tool position</source>
   <translation>Werkzeugstelle</translation>
  </message>
  <message>
   <source>Verify</source>
   <translation>Prüfen</translation>
  </message>
  <message>
   <source>What the axis of the operation comes to.</source>
   <translation>Was die Achse der Operation ergibt.</translation>
  </message>
 </context>
 <context>
  <name>ToolAxisPlan</name>
  <message>
   <source> rev/min</source>
   <translation> U/min</translation>
  </message>
  <message>
   <source> µm</source>
   <translation> µm</translation>
  </message>
  <message>
   <source>+X</source>
   <translation>+X</translation>
  </message>
  <message>
   <source>+Y</source>
   <translation>+Y</translation>
  </message>
  <message>
   <source>+Z</source>
   <translation>+Z</translation>
  </message>
  <message>
   <source>-X</source>
   <translation>-X</translation>
  </message>
  <message>
   <source>-Y</source>
   <translation>-Y</translation>
  </message>
  <message>
   <source>-Z</source>
   <translation>-Z</translation>
  </message>
  <message>
   <source>4+1 axes</source>
   <translation>4+1 Achsen</translation>
  </message>
  <message>
   <source>A tool controller or tool bit of the document, or a cutter typed in below.</source>
   <translation>Ein Werkzeug des Dokuments, oder ein Fräser, dessen Maße unten stehen.</translation>
  </message>
  <message>
   <source>Add row</source>
   <translation>Zeile anfügen</translation>
  </message>
  <message>
   <source>Add selected</source>
   <translation>Auswahl hinzufügen</translation>
  </message>
  <message>
   <source>Add the faces selected in the 3D view; a body stands for all its sculptured faces.</source>
   <translation>Fügt die in der 3D-Ansicht ausgewählten Flächen hinzu; ein Körper steht für alle seine Freiformflächen.</translation>
  </message>
  <message>
   <source>Adds a row to the outline.</source>
   <translation>Fügt dem Umriss eine Zeile hinzu.</translation>
  </message>
  <message>
   <source>Advanced</source>
   <translation>Erweitert</translation>
  </message>
  <message>
   <source>Allowance</source>
   <translation>Aufmaß</translation>
  </message>
  <message>
   <source>Allowance on</source>
   <translation>Aufmaß auf</translation>
  </message>
  <message>
   <source>Allowances of single faces in mm, by face number; they replace Allowance under Passes.</source>
   <translation>Aufmaße einzelner Flächen in mm, nach Flächennummer; sie ersetzen das Aufmaß unter Bahnen.</translation>
  </message>
  <message>
   <source>Along the parameters of the face; in parallel planes that contain the tool axis; following the scallop height, so that passes lie as far apart as their strips are wide; or whichever of the first and the third is shorter. All but the first need fixed axes.</source>
   <translation>Längs der Parameter der Fläche; in parallelen Ebenen, in denen die Werkzeugachse liegt; der Rillenhöhe folgend, sodass die Bahnen so weit auseinander liegen, wie ihre Streifen breit sind; oder die kürzere von erster und dritter Art. Alle außer der ersten brauchen feste Achsen.</translation>
  </message>
  <message>
   <source>Also plans the same faces by other methods, and lists what they come to.</source>
   <translation>Plant dieselben Flächen auch mit anderen Verfahren und stellt die Ergebnisse nebeneinander.</translation>
  </message>
  <message>
   <source>Avoid faces</source>
   <translation>Flächen meiden</translation>
  </message>
  <message>
   <source>Axes</source>
   <translation>Achsen</translation>
  </message>
  <message>
   <source>Axis</source>
   <translation>Achse</translation>
  </message>
  <message>
   <source>Axis locked</source>
   <translation>Achse gesperrt</translation>
  </message>
  <message>
   <source>Azimuth</source>
   <translation>Azimut</translation>
  </message>
  <message>
   <source>Ball</source>
   <translation>Kugel</translation>
  </message>
  <message>
   <source>Bodies to avoid</source>
   <translation>Zu meidende Körper</translation>
  </message>
  <message>
   <source>Bull nose</source>
   <translation>Torusfräser</translation>
  </message>
  <message>
   <source>Collisions of cutter, shank, holder and machine with the part, clamps and each other, and gouges that Verify found.</source>
   <translation>Kollisionen von Fräser, Schaft, Halter und Maschine mit dem Teil, Spannmitteln und untereinander, und Konturverletzungen, die Prüfen fand.</translation>
  </message>
  <message>
   <source>Compare with other methods</source>
   <translation>Mit anderen Verfahren vergleichen</translation>
  </message>
  <message>
   <source>Compute</source>
   <translation>Berechnen</translation>
  </message>
  <message>
   <source>Cone axis</source>
   <translation>Kegelachse</translation>
  </message>
  <message>
   <source>Corner radius</source>
   <translation>Eckenradius</translation>
  </message>
  <message>
   <source>Cutter type</source>
   <translation>Fräsertyp</translation>
  </message>
  <message>
   <source>Diameter</source>
   <translation>Durchmesser</translation>
  </message>
  <message>
   <source>Diameter at each height. Empty: as thick as the upper end of the cutter.</source>
   <translation>Durchmesser in jeder Höhe. Leer: so dick wie das obere Ende des Fräsers.</translation>
  </message>
  <message>
   <source>Diameter at each height. Empty: the holder is not checked.</source>
   <translation>Durchmesser in jeder Höhe. Leer: der Halter wird nicht geprüft.</translation>
  </message>
  <message>
   <source>Diameter of the cutter; of a tapered cutter, at its tip.</source>
   <translation>Durchmesser des Fräsers; bei einem konischen Fräser an der Spitze.</translation>
  </message>
  <message>
   <source>Direction</source>
   <translation>Richtung</translation>
  </message>
  <message>
   <source>Division</source>
   <translation>Aufteilung</translation>
  </message>
  <message>
   <source>Faces</source>
   <translation>Flächen</translation>
  </message>
  <message>
   <source>Faces to machine</source>
   <translation>Zu bearbeitende Flächen</translation>
  </message>
  <message>
   <source>Feed direction locked</source>
   <translation>Vorschubrichtung gesperrt</translation>
  </message>
  <message>
   <source>Feed rate</source>
   <translation>Vorschub</translation>
  </message>
  <message>
   <source>Feed rate of the cutting motion.</source>
   <translation>Vorschub der Schnittbewegung.</translation>
  </message>
  <message>
   <source>Filter: Face12, or &lt; 5 for small faces</source>
   <translation>Filter: Face12, oder &lt; 5 für kleine Flächen</translation>
  </message>
  <message>
   <source>Flat end mill</source>
   <translation>Schaftfräser</translation>
  </message>
  <message>
   <source>Flute length</source>
   <translation>Schneidenlänge</translation>
  </message>
  <message>
   <source>From the tip to the lower face of the holder.</source>
   <translation>Von der Spitze bis zur Unterseite des Halters.</translation>
  </message>
  <message>
   <source>Greatest angle</source>
   <translation>Größter Winkel</translation>
  </message>
  <message>
   <source>Greatest angle between the tool axis and the middle.</source>
   <translation>Größter Winkel zwischen Werkzeugachse und Mitte.</translation>
  </message>
  <message>
   <source>Greatest distance of neighbouring passes, whatever the scallop height allows; 0 for none.</source>
   <translation>Größter Abstand benachbarter Bahnen, was auch immer die Rillenhöhe zulässt; 0 für keinen.</translation>
  </message>
  <message>
   <source>Greatest height left between neighbouring passes.</source>
   <translation>Größte Höhe, die zwischen benachbarten Bahnen stehen bleibt.</translation>
  </message>
  <message>
   <source>Greatest number of tools of the rack that are used.</source>
   <translation>So viele Werkzeuge des Magazins werden höchstens eingesetzt.</translation>
  </message>
  <message>
   <source>Greatest roughness across the feed.</source>
   <translation>Größte Rauheit quer zum Vorschub.</translation>
  </message>
  <message>
   <source>Greatest turn of the tool axis about the middle.</source>
   <translation>Größte Drehung der Werkzeugachse um die Mitte.</translation>
  </message>
  <message>
   <source>Half angle</source>
   <translation>Halber Winkel</translation>
  </message>
  <message>
   <source>Held side</source>
   <translation>Gespannte Seite</translation>
  </message>
  <message>
   <source>Holder, heights from its lower face</source>
   <translation>Halter, Höhen ab seiner Unterseite</translation>
  </message>
  <message>
   <source>How far the stock reaches beyond the part on the side +X.</source>
   <translation>Wie weit das Rohteil auf der Seite +X über das Teil hinausreicht.</translation>
  </message>
  <message>
   <source>How far the stock reaches beyond the part on the side +Y.</source>
   <translation>Wie weit das Rohteil auf der Seite +Y über das Teil hinausreicht.</translation>
  </message>
  <message>
   <source>How far the stock reaches beyond the part on the side +Z.</source>
   <translation>Wie weit das Rohteil auf der Seite +Z über das Teil hinausreicht.</translation>
  </message>
  <message>
   <source>How far the stock reaches beyond the part on the side -X.</source>
   <translation>Wie weit das Rohteil auf der Seite -X über das Teil hinausreicht.</translation>
  </message>
  <message>
   <source>How far the stock reaches beyond the part on the side -Y.</source>
   <translation>Wie weit das Rohteil auf der Seite -Y über das Teil hinausreicht.</translation>
  </message>
  <message>
   <source>How far the stock reaches beyond the part on the side -Z.</source>
   <translation>Wie weit das Rohteil auf der Seite -Z über das Teil hinausreicht.</translation>
  </message>
  <message>
   <source>How many different axes there are in all; automatic: every number is tried, and a curve shows what each comes to.</source>
   <translation>Wie viele verschiedene Achsen es insgesamt gibt; automatisch: jede Anzahl wird versucht, und eine Kurve zeigt, was dabei herauskommt.</translation>
  </message>
  <message>
   <source>How many times faster than the machine it is played.</source>
   <translation>Um wie viel schneller als auf der Maschine abgespielt wird.</translation>
  </message>
  <message>
   <source>How the axis of each sub-surface is found; greatest jerk needs a machine; those after it are there for comparison.</source>
   <translation>Wie die Achse jeder Teilfläche gefunden wird; größter Ruck braucht eine Maschine; alle danach dienen dem Vergleich.</translation>
  </message>
  <message>
   <source>Inclination of the side from the axis.</source>
   <translation>Neigung der Seite gegen die Achse.</translation>
  </message>
  <message>
   <source>Into how many sub-surfaces each face is divided; automatic: as many as pay for their index moves, around bosses too.</source>
   <translation>In wie viele Teilflächen jede Fläche geteilt wird; automatisch: so viele, wie sich trotz ihrer Schwenkbewegungen lohnen, auch um Zapfen herum.</translation>
  </message>
  <message>
   <source>Job</source>
   <translation>Auftrag</translation>
  </message>
  <message>
   <source>Keep this axis, and the border of its sub-surface, when the plan is computed again.</source>
   <translation>Diese Achse und die Grenze ihrer Teilfläche behalten, wenn der Plan neu berechnet wird.</translation>
  </message>
  <message>
   <source>Keep this feed direction, and the border of its sub-surface, when the plan is computed again.</source>
   <translation>Diese Vorschubrichtung und die Grenze ihrer Teilfläche behalten, wenn der Plan neu berechnet wird.</translation>
  </message>
  <message>
   <source>Lead-in radius</source>
   <translation>Anfahrradius</translation>
  </message>
  <message>
   <source>Lean at least</source>
   <translation>Min. Neigung</translation>
  </message>
  <message>
   <source>Least angle between the tool axis and the middle.</source>
   <translation>Kleinster Winkel zwischen Werkzeugachse und Mitte.</translation>
  </message>
  <message>
   <source>Least angle of ball ends to the normal of the face, so that the tip does not cut; 0 for none.</source>
   <translation>Kleinster Winkel von Kugelfräsern zur Flächennormalen, damit die Spitze nicht schneidet; 0 für keinen.</translation>
  </message>
  <message>
   <source>Least turn of the tool axis about the middle.</source>
   <translation>Kleinste Drehung der Werkzeugachse um die Mitte.</translation>
  </message>
  <message>
   <source>Length of the cutting edge from the tip; above it the shank begins. 0: two diameters, as far as the stick-out allows.</source>
   <translation>Länge der Schneide von der Spitze an; darüber beginnt der Schaft. 0: zwei Durchmesser, soweit die Auskraglänge reicht.</translation>
  </message>
  <message>
   <source>Lists all faces, or only those that can be seen in the 3D view from where one looks now, or only those that cannot: hidden bodies and what other faces cover. The list follows when the view is turned.</source>
   <translation>Listet alle Flächen auf, oder nur die, die in der 3D-Ansicht von da zu sehen sind, von wo man gerade blickt, oder nur die anderen: ausgeblendete Körper und was andere Flächen verdecken. Die Liste folgt, wenn die Ansicht gedreht wird.</translation>
  </message>
  <message>
   <source>Looks for the axes of the faces with what the tabs hold; nothing enters the document yet.</source>
   <translation>Sucht die Achsen der Flächen mit dem, was auf den Reitern steht; ins Dokument kommt noch nichts.</translation>
  </message>
  <message>
   <source>Machine</source>
   <translation>Maschine</translation>
  </message>
  <message>
   <source>Machining tolerance: how far the finished surface may be cut too deep.</source>
   <translation>Bearbeitungstoleranz: wie weit die fertige Fläche zu tief geschnitten werden darf.</translation>
  </message>
  <message>
   <source>Margins of the stock</source>
   <translation>Aufmaß des Rohteils</translation>
  </message>
  <message>
   <source>Method</source>
   <translation>Verfahren</translation>
  </message>
  <message>
   <source>Middle of the allowed axes, x.</source>
   <translation>Mitte der erlaubten Achsen, x.</translation>
  </message>
  <message>
   <source>Middle of the allowed axes, y.</source>
   <translation>Mitte der erlaubten Achsen, y.</translation>
  </message>
  <message>
   <source>Middle of the allowed axes, z.</source>
   <translation>Mitte der erlaubten Achsen, z.</translation>
  </message>
  <message>
   <source>Minimise</source>
   <translation>Minimieren</translation>
  </message>
  <message>
   <source>Moves the tool along the passes of all operations.</source>
   <translation>Bewegt das Werkzeug längs der Bahnen aller Operationen.</translation>
  </message>
  <message>
   <source>Moves tool and holder along the passes.</source>
   <translation>Bewegt Werkzeug und Halter entlang der Bahnen.</translation>
  </message>
  <message>
   <source>Number of different tool axes at most.</source>
   <translation>Höchste Zahl verschiedener Werkzeugachsen.</translation>
  </message>
  <message>
   <source>Number of sub-surfaces of each face.</source>
   <translation>Zahl der Teilflächen jeder Fläche.</translation>
  </message>
  <message>
   <source>Numbers of faces of the part that no tool may touch.</source>
   <translation>Nummern von Flächen des Teils, die kein Werkzeug berühren darf.</translation>
  </message>
  <message>
   <source>One tool, or a rack to choose from: large tools begin, smaller ones finish what they leave.</source>
   <translation>Ein Werkzeug, oder ein Magazin zur Auswahl: Große beginnen, kleinere bearbeiten, was sie übrig lassen.</translation>
  </message>
  <message>
   <source>Origin</source>
   <translation>Nullpunkt</translation>
  </message>
  <message>
   <source>Other feed direction</source>
   <translation>Andere Vorschubrichtung</translation>
  </message>
  <message>
   <source>Passes</source>
   <translation>Bahnen</translation>
  </message>
  <message>
   <source>Pattern</source>
   <translation>Muster</translation>
  </message>
  <message>
   <source>Pictures...</source>
   <translation>Bilder...</translation>
  </message>
  <message>
   <source>Plan one blade, turn it</source>
   <translation>Eine Schaufel planen und drehen</translation>
  </message>
  <message>
   <source>Plan orientations</source>
   <translation>Orientierungen planen</translation>
  </message>
  <message>
   <source>Plan the face with the axis that the search found.</source>
   <translation>Plant die Fläche mit der Achse, die die Suche gefunden hat.</translation>
  </message>
  <message>
   <source>Plan the face with the axis that was tried.</source>
   <translation>Plant die Fläche mit der ausprobierten Achse.</translation>
  </message>
  <message>
   <source>Play</source>
   <translation>Abspielen</translation>
  </message>
  <message>
   <source>Play all operations</source>
   <translation>Alle Operationen abspielen</translation>
  </message>
  <message>
   <source>Plays all operations in sequence with the index moves between them, on the machine if one is chosen.</source>
   <translation>Spielt alle Operationen der Reihe nach mit den Schwenkbewegungen dazwischen ab, auf der Maschine, wenn eine gewählt ist.</translation>
  </message>
  <message>
   <source>Plays all operations in their order, with the index moves between them.</source>
   <translation>Spielt alle Operationen in ihrer Reihenfolge ab, mit den Schwenkbewegungen dazwischen.</translation>
  </message>
  <message>
   <source>Point</source>
   <translation>Punkt</translation>
  </message>
  <message>
   <source>Radius of the arcs on which the tool comes down to passes and is lifted from them, wherever these are proven free; 0 for straight ramps.</source>
   <translation>Radius der Bögen, auf denen das Werkzeug an Bahnen heran- und von ihnen wegfährt, wo sie nachweislich frei sind; 0 für gerade Rampen.</translation>
  </message>
  <message>
   <source>Radius of the rounded corner.</source>
   <translation>Radius der gerundeten Ecke.</translation>
  </message>
  <message>
   <source>Rates</source>
   <translation>Vorschub und Drehzahl</translation>
  </message>
  <message>
   <source>Raw stock</source>
   <translation>Rohteil</translation>
  </message>
  <message>
   <source>Remove</source>
   <translation>Entfernen</translation>
  </message>
  <message>
   <source>Remove row</source>
   <translation>Zeile entfernen</translation>
  </message>
  <message>
   <source>Remove the marked faces from the list.</source>
   <translation>Entfernt die markierten Flächen aus der Liste.</translation>
  </message>
  <message>
   <source>Removes the marked rows, or the last one.</source>
   <translation>Entfernt die markierten Zeilen, sonst die letzte.</translation>
  </message>
  <message>
   <source>Restore best axis</source>
   <translation>Beste Achse wiederherstellen</translation>
  </message>
  <message>
   <source>Revolutions of the spindle per minute.</source>
   <translation>Umdrehungen der Spindel in der Minute.</translation>
  </message>
  <message>
   <source>Roman's rule</source>
   <translation>Regel von Roman</translation>
  </message>
  <message>
   <source>Roughness Ra</source>
   <translation>Rauheit Ra</translation>
  </message>
  <message>
   <source>Scallop height</source>
   <translation>Rillenhöhe</translation>
  </message>
  <message>
   <source>Sets this in the fields and computes again. It may help; only the new result tells.</source>
   <translation>Trägt dies in die Felder ein und rechnet neu. Es kann helfen; erst das neue Ergebnis sagt es.</translation>
  </message>
  <message>
   <source>Setup</source>
   <translation>Aufspannung</translation>
  </message>
  <message>
   <source>Shank, heights from the tip</source>
   <translation>Schaft, Höhen ab der Spitze</translation>
  </message>
  <message>
   <source>Shape of the cutter's end.</source>
   <translation>Form des Fräserendes.</translation>
  </message>
  <message>
   <source>Shows only the faces whose name has this text, or whose area is less than a number: &lt; 5. Remove then takes the marked ones off the list, Ctrl+A marks all that are shown.</source>
   <translation>Zeigt nur die Flächen, deren Name diesen Text enthält oder deren Inhalt kleiner als eine Zahl ist: &lt; 5. Entfernen nimmt dann die markierten von der Liste, Strg+A markiert alle gezeigten.</translation>
  </message>
  <message>
   <source>Shows pictures of the plan in a window: passes, contacts, angles and axis motion.</source>
   <translation>Zeigt Bilder des Plans in einem Fenster: Bahnen, Kontakte, Winkel und Achsbewegungen.</translation>
  </message>
  <message>
   <source>Side of the part that is clamped: no tool goes there. Face areas on that side are left for another setup.</source>
   <translation>Gespannte Seite des Teils: Dort fährt kein Werkzeug hin. Was von den Flächen dort liegt, bleibt für eine andere Aufspannung.</translation>
  </message>
  <message>
   <source>Spindle</source>
   <translation>Spindel</translation>
  </message>
  <message>
   <source>Step-over at most</source>
   <translation>Max. Bahnabstand</translation>
  </message>
  <message>
   <source>Stick-out</source>
   <translation>Auskraglänge</translation>
  </message>
  <message>
   <source>Stock</source>
   <translation>Schruppaufmaß</translation>
  </message>
  <message>
   <source>Stock and faces</source>
   <translation>Schruppaufmaß und Flächen</translation>
  </message>
  <message>
   <source>Stock left on the faces.</source>
   <translation>Was auf den Flächen stehen bleibt.</translation>
  </message>
  <message>
   <source>Stock that roughing left on the faces (at least the allowance). Shank and holder keep clear of it. 0: the faces are finished.</source>
   <translation>Material, das vom Schruppen auf den Flächen steht (mindestens das Aufmaß). Schaft und Halter halten Abstand dazu. 0: Die Flächen sind fertig.</translation>
  </message>
  <message>
   <source>Stop</source>
   <translation>Stopp</translation>
  </message>
  <message>
   <source>Stops the computation; what is found of whole faces by then stays.</source>
   <translation>Hält die Berechnung an; was bis dahin für ganze Flächen gefunden ist, bleibt.</translation>
  </message>
  <message>
   <source>Strategy</source>
   <translation>Strategie</translation>
  </message>
  <message>
   <source>Sub-surfaces</source>
   <translation>Teilflächen</translation>
  </message>
  <message>
   <source>Takes the vertex that is selected in the 3D view as the origin. It moves along with the part.</source>
   <translation>Nimmt den in der 3D-Ansicht ausgewählten Punkt als Nullpunkt. Er bewegt sich mit dem Teil.</translation>
  </message>
  <message>
   <source>Tapered</source>
   <translation>Kegelig</translation>
  </message>
  <message>
   <source>The face whose map is shown.</source>
   <translation>Die Fläche, deren Karte gezeigt wird.</translation>
  </message>
  <message>
   <source>The faces to machine; each gets a tool axis of its own.</source>
   <translation>Die zu bearbeitenden Flächen; jede bekommt eine eigene Werkzeugachse.</translation>
  </message>
  <message>
   <source>The machine whose rotary axes must reach the tool axis, or limits of your own: a cone, or ranges of two angles.</source>
   <translation>Die Maschine, deren Drehachsen die Werkzeugachse erreichen müssen, oder eigene Grenzen: ein Kegel oder Bereiche zweier Winkel.</translation>
  </message>
  <message>
   <source>The point of the box. The box lies along X, Y and Z of the document: left is -X, front is -Y.</source>
   <translation>Der Punkt des Quaders. Der Quader liegt längs X, Y und Z des Dokuments: links ist -X, vorn ist -Y.</translation>
  </message>
  <message>
   <source>The rest of the part is always kept clear of; ticked bodies too.</source>
   <translation>Der Rest des Teils wird immer gemieden, angekreuzte Körper auch.</translation>
  </message>
  <message>
   <source>The tools of the plan in their colours, what they machine, and their time.</source>
   <translation>Die Werkzeuge des Plans in ihren Farben, was sie bearbeiten, und ihre Zeit.</translation>
  </message>
  <message>
   <source>The tools that can be chosen: number, name.</source>
   <translation>Die Werkzeuge, die zur Wahl stehen: Nummer, Name.</translation>
  </message>
  <message>
   <source>Tilt</source>
   <translation>Neigung</translation>
  </message>
  <message>
   <source>Time so far and in all, and how it divides into cutting and all other moves: lead-ins, links, index moves and changes of tool.</source>
   <translation>Bisherige und gesamte Zeit, und wie sie sich auf Schnitt und alle anderen Bewegungen verteilt: Ein- und Auslauf, Verbindungen, Schwenkbewegungen und Werkzeugwechsel.</translation>
  </message>
  <message>
   <source>To and fro, or all passes one way so that the cutter climbs or cuts conventionally.</source>
   <translation>Hin und her, oder alle Bahnen in einer Richtung, im Gleichlauf oder im Gegenlauf.</translation>
  </message>
  <message>
   <source>Tolerance</source>
   <translation>Toleranz</translation>
  </message>
  <message>
   <source>Tool</source>
   <translation>Werkzeug</translation>
  </message>
  <message>
   <source>Tool position</source>
   <translation>Werkzeugstelle</translation>
  </message>
  <message>
   <source>Tool source</source>
   <translation>Werkzeug aus</translation>
  </message>
  <message>
   <source>Tools</source>
   <translation>Werkzeuge</translation>
  </message>
  <message>
   <source>Tools of the rack</source>
   <translation>Werkzeuge des Magazins</translation>
  </message>
  <message>
   <source>Try the passes along the other parameter lines, with the same axis.</source>
   <translation>Probiert mit derselben Achse die Bahnen entlang der anderen Parameterlinien aus.</translation>
  </message>
  <message>
   <source>Use at most</source>
   <translation>Höchstens</translation>
  </message>
  <message>
   <source>Use selected</source>
   <translation>Auswahl nehmen</translation>
  </message>
  <message>
   <source>Use this axis</source>
   <translation>Diese Achse verwenden</translation>
  </message>
  <message>
   <source>Vertex</source>
   <translation>Eckpunkt</translation>
  </message>
  <message>
   <source>What other methods need for the same faces.</source>
   <translation>Was andere Verfahren für dieselben Flächen brauchen.</translation>
  </message>
  <message>
   <source>What the axis comes to, and beside it what the one comes to that is tried.</source>
   <translation>Was die Achse ergibt, und daneben, was die versuchte ergibt.</translation>
  </message>
  <message>
   <source>What the part is cut from: it goes into CAM jobs and onto the setup sheet.</source>
   <translation>Woraus das Teil gefräst wird: steht in den CAM-Jobs und auf dem Einrichteblatt.</translation>
  </message>
  <message>
   <source>What the tool axis is chosen by.</source>
   <translation>Wonach die Werkzeugachse gewählt wird.</translation>
  </message>
  <message>
   <source>Where all faces of a part with blades are chosen, one blade is planned, and what is done there is turned to the others and proven there.</source>
   <translation>Sind alle Flächen eines Teils mit Schaufeln gewählt, wird eine Schaufel geplant; was dort geschieht, wird zu den anderen gedreht und dort nachgewiesen.</translation>
  </message>
  <message>
   <source>Where the work coordinate systems, jobs and programs have X, Y and Z zero.</source>
   <translation>Wo Werkstückkoordinatensysteme, Jobs und Programme X, Y und Z null haben.</translation>
  </message>
  <message>
   <source>Whether the tool axis stands still while it cuts, or how it moves.</source>
   <translation>Ob die Werkzeugachse beim Schneiden stillsteht, oder wie sie sich bewegt.</translation>
  </message>
  <message>
   <source>all faces</source>
   <translation>alle Flächen</translation>
  </message>
  <message>
   <source>along parameters</source>
   <translation>längs der Parameter</translation>
  </message>
  <message>
   <source>any machine</source>
   <translation>beliebige Maschine</translation>
  </message>
  <message>
   <source>any number of tools</source>
   <translation>beliebig viele Werkzeuge</translation>
  </message>
  <message>
   <source>any, axis within a cone</source>
   <translation>beliebig, Achse in einem Kegel</translation>
  </message>
  <message>
   <source>any, tilt and turn limited</source>
   <translation>beliebig, Neigung und Drehung begrenzt</translation>
  </message>
  <message>
   <source>as the CAM job makes it</source>
   <translation>wie der CAM-Job es anlegt</translation>
  </message>
  <message>
   <source>at most</source>
   <translation>höchstens</translation>
  </message>
  <message>
   <source>automatic</source>
   <translation>automatisch</translation>
  </message>
  <message>
   <source>ball end, mean normals</source>
   <translation>Kugelfräser, mittlere Normalen</translation>
  </message>
  <message>
   <source>best of hemisphere</source>
   <translation>beste der Halbkugel</translation>
  </message>
  <message>
   <source>blade, key points</source>
   <translation>Schaufel, Stützpunkte</translation>
  </message>
  <message>
   <source>blade, least acceleration</source>
   <translation>Schaufel, kleinste Beschleunigung</translation>
  </message>
  <message>
   <source>bottom, back left</source>
   <translation>unten, hinten links</translation>
  </message>
  <message>
   <source>bottom, back right</source>
   <translation>unten, hinten rechts</translation>
  </message>
  <message>
   <source>bottom, front left</source>
   <translation>unten, vorn links</translation>
  </message>
  <message>
   <source>bottom, front right</source>
   <translation>unten, vorn rechts</translation>
  </message>
  <message>
   <source>bottom, middle</source>
   <translation>unten, Mitte</translation>
  </message>
  <message>
   <source>box with margins</source>
   <translation>Quader mit Aufmaß</translation>
  </message>
  <message>
   <source>climb</source>
   <translation>Gleichlauf</translation>
  </message>
  <message>
   <source>conventional</source>
   <translation>Gegenlauf</translation>
  </message>
  <message>
   <source>cutting length</source>
   <translation>Schnittlänge</translation>
  </message>
  <message>
   <source>five axes, constant lead</source>
   <translation>fünf Achsen, fester Voreilwinkel</translation>
  </message>
  <message>
   <source>fixed axes (3+2)</source>
   <translation>feste Achsen (3+2)</translation>
  </message>
  <message>
   <source>following the scallop height</source>
   <translation>der Rillenhöhe folgend</translation>
  </message>
  <message>
   <source>greatest jerk along passes</source>
   <translation>größter Ruck längs der Bahnen</translation>
  </message>
  <message>
   <source>hidden</source>
   <translation>verdeckte</translation>
  </message>
  <message>
   <source>in parallel planes</source>
   <translation>in parallelen Ebenen</translation>
  </message>
  <message>
   <source>in sight</source>
   <translation>sichtbare</translation>
  </message>
  <message>
   <source>mean normals</source>
   <translation>mittlere Normalen</translation>
  </message>
  <message>
   <source>middle</source>
   <translation>Mitte</translation>
  </message>
  <message>
   <source>number</source>
   <translation>Anzahl</translation>
  </message>
  <message>
   <source>number of passes</source>
   <translation>Anzahl der Bahnen</translation>
  </message>
  <message>
   <source>one axis for all</source>
   <translation>eine Achse für alle</translation>
  </message>
  <message>
   <source>one each</source>
   <translation>je eine</translation>
  </message>
  <message>
   <source>part's own origin</source>
   <translation>Ursprung des Teils</translation>
  </message>
  <message>
   <source>picked vertex</source>
   <translation>gewählter Punkt</translation>
  </message>
  <message>
   <source>point of the part</source>
   <translation>Punkt des Teils</translation>
  </message>
  <message>
   <source>point of the stock</source>
   <translation>Punkt des Rohteils</translation>
  </message>
  <message>
   <source>sectors</source>
   <translation>Sektoren</translation>
  </message>
  <message>
   <source>strip width and roughness</source>
   <translation>Streifenbreite und Rauheit</translation>
  </message>
  <message>
   <source>top, back left</source>
   <translation>oben, hinten links</translation>
  </message>
  <message>
   <source>top, back right</source>
   <translation>oben, hinten rechts</translation>
  </message>
  <message>
   <source>top, front left</source>
   <translation>oben, vorn links</translation>
  </message>
  <message>
   <source>top, front right</source>
   <translation>oben, vorn rechts</translation>
  </message>
  <message>
   <source>top, middle</source>
   <translation>oben, Mitte</translation>
  </message>
  <message>
   <source>two-point contact</source>
   <translation>Berührung an zwei Punkten</translation>
  </message>
  <message>
   <source>whichever is shorter</source>
   <translation>die kürzeren von beiden</translation>
  </message>
  <message>
   <source>whole faces</source>
   <translation>ganze Flächen</translation>
  </message>
  <message>
   <source>zigzag</source>
   <translation>hin und her</translation>
  </message>
 </context>
 <context>
  <name>ToolAxisPlay</name>
  <message>
   <source>Collisions of cutter, shank, holder and machine with the part, clamps and each other, and gouges that Verify found.</source>
   <translation>Kollisionen von Fräser, Schaft, Halter und Maschine mit dem Teil, Spannmitteln und untereinander, und Konturverletzungen, die Prüfen fand.</translation>
  </message>
  <message>
   <source>How many times faster than the machine it is played.</source>
   <translation>Um wie viel schneller als auf der Maschine abgespielt wird.</translation>
  </message>
  <message>
   <source>Look from the machine's bed</source>
   <translation>Vom Maschinenbett aus betrachten</translation>
  </message>
  <message>
   <source>Moves the tool along the passes of all operations.</source>
   <translation>Bewegt das Werkzeug längs der Bahnen aller Operationen.</translation>
  </message>
  <message>
   <source>Play</source>
   <translation>Abspielen</translation>
  </message>
  <message>
   <source>Plays all operations in their order, with the index moves between them.</source>
   <translation>Spielt alle Operationen in ihrer Reihenfolge ab, mit den Schwenkbewegungen dazwischen.</translation>
  </message>
  <message>
   <source>The camera stays with the machine's bed, so that the table turns; otherwise it stays with the part.</source>
   <translation>Die Kamera bleibt beim Maschinenbett, so dass sich der Tisch dreht; sonst bleibt sie beim Teil.</translation>
  </message>
  <message>
   <source>Time so far and in all, and how it divides into cutting and all other moves: lead-ins, links, index moves and changes of tool.</source>
   <translation>Bisherige und gesamte Zeit, und wie sie sich auf Schnitt und alle anderen Bewegungen verteilt: Ein- und Auslauf, Verbindungen, Schwenkbewegungen und Werkzeugwechsel.</translation>
  </message>
 </context>
 <context>
  <name>ToolAxisPreferences</name>
  <message>
   <source> mm</source>
   <translation> mm</translation>
  </message>
  <message>
   <source> mm/min</source>
   <translation> mm/min</translation>
  </message>
  <message>
   <source> rev/min</source>
   <translation> U/min</translation>
  </message>
  <message>
   <source>Colour of the cutting motion.</source>
   <translation>Farbe der schneidenden Bewegung.</translation>
  </message>
  <message>
   <source>Colour of the motion between passes.</source>
   <translation>Farbe der Bewegung zwischen den Bahnen.</translation>
  </message>
  <message>
   <source>Colours while a plan is looked at</source>
   <translation>Farben, während ein Plan betrachtet wird</translation>
  </message>
  <message>
   <source>Computing</source>
   <translation>Rechnen</translation>
  </message>
  <message>
   <source>Cuts</source>
   <translation>Schnitte</translation>
  </message>
  <message>
   <source>Feed rate</source>
   <translation>Vorschub</translation>
  </message>
  <message>
   <source>Feed rate of the cutting motion.</source>
   <translation>Vorschub der schneidenden Bewegung.</translation>
  </message>
  <message>
   <source>Folder</source>
   <translation>Ordner</translation>
  </message>
  <message>
   <source>General</source>
   <translation>Allgemein</translation>
  </message>
  <message>
   <source>Greatest height left between neighbouring passes.</source>
   <translation>Größte Höhe, die zwischen benachbarten Bahnen stehen bleibt.</translation>
  </message>
  <message>
   <source>Links</source>
   <translation>Verbindungen</translation>
  </message>
  <message>
   <source>Machine files in this folder are offered besides those of the library: TOML, and FreeCAD's .fcm.</source>
   <translation>Maschinendateien in diesem Ordner werden neben denen der Bibliothek angeboten: TOML und .fcm von FreeCAD.</translation>
  </message>
  <message>
   <source>Machines</source>
   <translation>Maschinen</translation>
  </message>
  <message>
   <source>New plans</source>
   <translation>Neue Pläne</translation>
  </message>
  <message>
   <source>Scallop height</source>
   <translation>Rillenhöhe</translation>
  </message>
  <message>
   <source>Short form of the cutter, such as torus:12x1, ball:8, flat:20 or tapered:6x3x4. Empty: one that fits the part.</source>
   <translation>Kurzform des Fräsers, etwa torus:12x1, ball:8, flat:20 oder tapered:6x3x4. Leer: einer, der zum Teil passt.</translation>
  </message>
  <message>
   <source>Spindle</source>
   <translation>Spindel</translation>
  </message>
  <message>
   <source>Spindle speed.</source>
   <translation>Drehzahl der Spindel.</translation>
  </message>
  <message>
   <source>Threads</source>
   <translation>Threads</translation>
  </message>
  <message>
   <source>Threads for Verify. They do not change its result. Planning uses one.</source>
   <translation>Threads für die Prüfung. Sie ändern das Ergebnis nicht. Die Planung nutzt einen.</translation>
  </message>
  <message>
   <source>Tool</source>
   <translation>Werkzeug</translation>
  </message>
  <message>
   <source>by the part</source>
   <translation>nach dem Teil</translation>
  </message>
 </context>
 <context>
  <name>ToolAxisVerify</name>
  <message>
   <source>A click zooms to the point.</source>
   <translation>Ein Klick zeigt den Punkt aus der Nähe.</translation>
  </message>
  <message>
   <source>Operation</source>
   <translation>Operation</translation>
  </message>
  <message>
   <source>Painted</source>
   <translation>Gezeigt</translation>
  </message>
  <message>
   <source>Removes material along the passes and measures what is left.</source>
   <translation>Trägt Material entlang der Bahnen ab und misst, was bleibt.</translation>
  </message>
  <message>
   <source>Stop</source>
   <translation>Stopp</translation>
  </message>
  <message>
   <source>Stops the judge.</source>
   <translation>Hält die Prüfung an.</translation>
  </message>
  <message>
   <source>Verify</source>
   <translation>Prüfen</translation>
  </message>
  <message>
   <source>What the colours on the face show.</source>
   <translation>Was die Farben auf der Fläche zeigen.</translation>
  </message>
  <message>
   <source>What the judge measured, and what is allowed.</source>
   <translation>Was die Prüfung gemessen hat, und was erlaubt ist.</translation>
  </message>
  <message>
   <source>Which operation is shown.</source>
   <translation>Welche Operation gezeigt wird.</translation>
  </message>
  <message>
   <source>Worst points; a click zooms to one</source>
   <translation>Schlimmste Stellen; ein Klick zeigt eine aus der Nähe</translation>
  </message>
  <message>
   <source>gouge</source>
   <translation>Konturverletzung</translation>
  </message>
  <message>
   <source>scallop height</source>
   <translation>Rillenhöhe</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_Examples</name>
  <message>
   <source>Biquintic patch</source>
   <translation>Biquintische Fläche</translation>
  </message>
  <message>
   <source>Blisk with 16 blades</source>
   <translation>Blisk mit 16 Schaufeln</translation>
  </message>
  <message>
   <source>Dish</source>
   <translation>Schale</translation>
  </message>
  <message>
   <source>Face with a boss</source>
   <translation>Fläche mit einem Zapfen</translation>
  </message>
  <message>
   <source>Face with an irregular outline</source>
   <translation>Fläche mit unregelmäßigem Umriss</translation>
  </message>
  <message>
   <source>Face with three bosses</source>
   <translation>Fläche mit drei Zapfen</translation>
  </message>
  <message>
   <source>Freeform face</source>
   <translation>Freiformfläche</translation>
  </message>
  <message>
   <source>Hyperbolic paraboloid</source>
   <translation>Hyperbolisches Paraboloid</translation>
  </message>
  <message>
   <source>Hyperbolic paraboloid along its rulings</source>
   <translation>Hyperbolisches Paraboloid längs seiner Erzeugenden</translation>
  </message>
  <message>
   <source>Impeller with nine blades</source>
   <translation>Laufrad mit neun Schaufeln</translation>
  </message>
  <message>
   <source>Manta surface</source>
   <translation>Manta-Fläche</translation>
  </message>
  <message>
   <source>Opens this example part in a document of its own</source>
   <translation>Öffnet dieses Beispielteil in einem eigenen Dokument</translation>
  </message>
  <message>
   <source>Saddle</source>
   <translation>Sattel</translation>
  </message>
  <message>
   <source>Skin of six faces</source>
   <translation>Haut aus sechs Flächen</translation>
  </message>
  <message>
   <source>Strong waves</source>
   <translation>Starke Wellen</translation>
  </message>
  <message>
   <source>Trimmed face with a hole</source>
   <translation>Getrimmte Fläche mit Loch</translation>
  </message>
  <message>
   <source>Turbine blade</source>
   <translation>Turbinenschaufel</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_Export</name>
  <message>
   <source>Export</source>
   <translation>Exportieren</translation>
  </message>
  <message>
   <source>Writes plan.json, CL files, an NC program with its setup sheet, and a report</source>
   <translation>Schreibt plan.json, CL-Dateien, ein NC-Programm mit Einrichteblatt und einen Bericht</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_Machine</name>
  <message>
   <source>Machine</source>
   <translation>Maschine</translation>
  </message>
  <message>
   <source>Picks a machine, shows where its rotary axes stand for each operation, and its index moves</source>
   <translation>Wählt eine Maschine und zeigt, wo ihre Drehachsen bei jeder Operation stehen, und ihre Schwenkbewegungen</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_MakeJobs</name>
  <message>
   <source>Make CAM Jobs</source>
   <translation>CAM-Aufträge anlegen</translation>
  </message>
  <message>
   <source>Makes jobs of FreeCAD's CAM workbench from operations: stock, tool and passes for each orientation, ready for a post-processor</source>
   <translation>Macht aus Operationen Aufträge des FreeCAD-Arbeitsbereichs CAM: Rohteil, Werkzeug und Bahnen für jede Orientierung, bereit für einen Postprozessor</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_Merge</name>
  <message>
   <source>Merge Sub-Surfaces</source>
   <translation>Teilflächen vereinen</translation>
  </message>
  <message>
   <source>Puts the selected sub-surfaces of a face together and plans them again</source>
   <translation>Vereint die ausgewählten Teilflächen einer Fläche und plant sie neu</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_PlanOrientations</name>
  <message>
   <source>Finds the best fixed tool axis for each selected face, its work coordinate system and its passes</source>
   <translation>Findet für jede ausgewählte Fläche die beste feste Werkzeugachse, ihr Werkstückkoordinatensystem und ihre Bahnen</translation>
  </message>
  <message>
   <source>Plan Orientations</source>
   <translation>Orientierungen planen</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_Play</name>
  <message>
   <source>Play</source>
   <translation>Abspielen</translation>
  </message>
  <message>
   <source>Plays all operations in sequence with tool, holder and machine; shows time, index moves and collisions</source>
   <translation>Spielt alle Operationen der Reihe nach mit Werkzeug, Halter und Maschine ab; zeigt Zeit, Schwenkbewegungen und Kollisionen</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_Recompute</name>
  <message>
   <source>Plans the selected operation again, for the part as it is now</source>
   <translation>Plant die ausgewählte Operation neu, für das Teil in seinem jetzigen Zustand</translation>
  </message>
  <message>
   <source>Recompute</source>
   <translation>Neu berechnen</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_Split</name>
  <message>
   <source>Cuts the selected sub-surface apart: along a wire or sketch that is selected with it, out of the face where that is closed, else in the middle</source>
   <translation>Zerteilt die ausgewählte Teilfläche: entlang eines mit ausgewählten Linienzugs oder einer Skizze, aus der Fläche heraus, wo diese geschlossen sind, sonst in der Mitte</translation>
  </message>
  <message>
   <source>Split Sub-Surface</source>
   <translation>Teilfläche zerteilen</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_Tour</name>
  <message>
   <source>Opens the tour from a part to a posted program, and from there the manual</source>
   <translation>Öffnet den Rundgang vom Teil zum fertigen Programm (englisch), und von dort das Handbuch</translation>
  </message>
  <message>
   <source>Tool Axis Tour</source>
   <translation>Rundgang durch Tool Axis</translation>
  </message>
 </context>
 <context>
  <name>ToolAxis_Verify</name>
  <message>
   <source>Removes material along the passes and shows scallops and gouges on the faces</source>
   <translation>Trägt entlang der Bahnen Material ab und zeigt Rillen und Konturverletzungen auf den Flächen</translation>
  </message>
  <message>
   <source>Verify</source>
   <translation>Prüfen</translation>
  </message>
 </context>
 <context>
  <name>Workbench</name>
  <message>
   <source>&amp;Tool Axis</source>
   <translation>&amp;Tool Axis</translation>
  </message>
  <message>
   <source>Examples</source>
   <translation>Beispiele</translation>
  </message>
  <message>
   <source>Tool Axis</source>
   <translation>Tool Axis</translation>
  </message>
  <message>
   <source>Tool axes, work coordinate systems and passes for sculptured faces</source>
   <translation>Werkzeugachsen, Werkstückkoordinatensysteme und Bahnen für Freiformflächen</translation>
  </message>
 </context>
</TS>
