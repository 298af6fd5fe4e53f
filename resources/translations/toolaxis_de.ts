<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
 <context>
  <name>App::Property</name>
  <message>
   <source>Allowances of single faces: 3,5-8=0.3;9=0.1</source>
   <translation>Aufmaße einzelner Flächen: 3,5-8=0.3;9=0.1</translation>
  </message>
  <message>
   <source>Allowed gouge</source>
   <translation>Erlaubte Konturverletzung</translation>
  </message>
  <message>
   <source>Allowed gouge of the finished face; double-click the operation to change it</source>
   <translation>Erlaubte Konturverletzung der fertigen Fläche; zum Ändern die Operation doppelt anklicken</translation>
  </message>
  <message>
   <source>Also plan the same faces by other methods</source>
   <translation>Dieselben Flächen auch mit anderen Verfahren planen</translation>
  </message>
  <message>
   <source>Area divided by cutting length</source>
   <translation>Fläche geteilt durch Schnittlänge</translation>
  </message>
  <message>
   <source>Area not begun when the plan was stopped</source>
   <translation>Fläche, die beim Stopp der Planung nicht begonnen war</translation>
  </message>
  <message>
   <source>Area of the faces, if planned with several tools</source>
   <translation>Inhalt der Flächen, wenn mit mehreren Werkzeugen geplant wurde</translation>
  </message>
  <message>
   <source>Area proven to be out of reach of every tool</source>
   <translation>Fläche, die nachweislich für jedes Werkzeug unerreichbar ist</translation>
  </message>
  <message>
   <source>Area that is machined</source>
   <translation>Bearbeitete Fläche</translation>
  </message>
  <message>
   <source>Area that was tried and stays open</source>
   <translation>Fläche, die versucht wurde und offen bleibt</translation>
  </message>
  <message>
   <source>Bodies to avoid</source>
   <translation>Zu meidende Körper</translation>
  </message>
  <message>
   <source>Changes that put the results out of date</source>
   <translation>Änderungen, durch die die Ergebnisse veraltet sind</translation>
  </message>
  <message>
   <source>Clamped side of the part: z&lt;12.5</source>
   <translation>Gespannte Seite des Teils: z&lt;12.5</translation>
  </message>
  <message>
   <source>Cutter: torus:12x1, ball:8, flat:20 or tapered:6x3x4</source>
   <translation>Fräser: torus:12x1, ball:8, flat:20 oder tapered:6x3x4</translation>
  </message>
  <message>
   <source>Data that are assumed</source>
   <translation>Angenommene Daten</translation>
  </message>
  <message>
   <source>Direction of the passes</source>
   <translation>Richtung der Bahnen</translation>
  </message>
  <message>
   <source>Faces of the part that no tool may touch: 3,5-8</source>
   <translation>Flächen des Teils, die kein Werkzeug berühren darf: 3,5-8</translation>
  </message>
  <message>
   <source>Feed rate of the cutting moves</source>
   <translation>Vorschub der Schnittbewegungen</translation>
  </message>
  <message>
   <source>Fixed axes, or how the axis moves while cutting</source>
   <translation>Feste Achsen, oder wie sich die Achse beim Schneiden bewegt</translation>
  </message>
  <message>
   <source>Its axes with their ranges</source>
   <translation>Ihre Achsen mit ihren Bereichen</translation>
  </message>
  <message>
   <source>Length from the tip to the holder's lower face</source>
   <translation>Länge von der Spitze bis zur Unterseite des Halters</translation>
  </message>
  <message>
   <source>Length of a line</source>
   <translation>Länge einer Linie</translation>
  </message>
  <message>
   <source>Length of lead-ins, lead-outs and links</source>
   <translation>Länge von An- und Abfahrbewegungen und Verbindungen</translation>
  </message>
  <message>
   <source>Length of the cutting edge from the tip; 0: two diameters</source>
   <translation>Länge der Schneide von der Spitze an; 0: zwei Durchmesser</translation>
  </message>
  <message>
   <source>Length of the cutting moves</source>
   <translation>Länge der Schnittbewegungen</translation>
  </message>
  <message>
   <source>Length of the cutting moves of all operations</source>
   <translation>Länge der Schnittbewegungen aller Operationen</translation>
  </message>
  <message>
   <source>Limits of the tool axis: cone:X,Y,Z,DEG or rotary:tilt=A..B,turn=C..D</source>
   <translation>Grenzen der Werkzeugachse: cone:X,Y,Z,GRAD oder rotary:tilt=A..B,turn=C..D</translation>
  </message>
  <message>
   <source>Lower bound of the distance from the cutter to everything but the machined faces</source>
   <translation>Untergrenze des Abstands des Fräsers zu allem außer den bearbeiteten Flächen</translation>
  </message>
  <message>
   <source>Lower bound of the distance from the holder to everything but the machined faces</source>
   <translation>Untergrenze des Abstands des Halters zu allem außer den bearbeiteten Flächen</translation>
  </message>
  <message>
   <source>Lower bound of the distance from the shank to everything but the machined faces</source>
   <translation>Untergrenze des Abstands des Schafts zu allem außer den bearbeiteten Flächen</translation>
  </message>
  <message>
   <source>Lower bounds of clearances, proven on this blade</source>
   <translation>Untergrenzen der Abstände, auf dieser Schaufel nachgewiesen</translation>
  </message>
  <message>
   <source>Margins of the stock: 2, or 1,1,1,1,0,2 for -X, +X, -Y, +Y, -Z, +Z; nothing: as the CAM job makes it</source>
   <translation>Zugaben des Rohteils: 2, oder 1,1,1,1,0,2 für -X, +X, -Y, +Y, -Z, +Z; nichts: wie der CAM-Auftrag es anlegt</translation>
  </message>
  <message>
   <source>Material left by roughing; double-click the operation to change it</source>
   <translation>Material, das vom Schruppen steht; zum Ändern die Operation doppelt anklicken</translation>
  </message>
  <message>
   <source>Material to leave on the face; double-click the operation to change it</source>
   <translation>Material, das auf der Fläche stehen bleiben soll; zum Ändern die Operation doppelt anklicken</translation>
  </message>
  <message>
   <source>Maximum Ra across the feed, micrometres, for strategies that use it</source>
   <translation>Größter Ra quer zum Vorschub, Mikrometer, für Strategien, die ihn verwenden</translation>
  </message>
  <message>
   <source>Maximum gouge</source>
   <translation>Größte Konturverletzung</translation>
  </message>
  <message>
   <source>Maximum number of orientations: a number, auto, or nothing for one each</source>
   <translation>Größte Zahl der Orientierungen: eine Zahl, auto, oder nichts für je eine</translation>
  </message>
  <message>
   <source>Maximum number of tools from the rack; 0: any number</source>
   <translation>Größte Zahl der Werkzeuge des Magazins; 0: beliebig viele</translation>
  </message>
  <message>
   <source>Maximum scallop height where the cutter came</source>
   <translation>Größte Rillenhöhe, wo der Fräser hinkam</translation>
  </message>
  <message>
   <source>Maximum scallop height; double-click the operation to change it</source>
   <translation>Größte Rillenhöhe; zum Ändern die Operation doppelt anklicken</translation>
  </message>
  <message>
   <source>Maximum step-over, 0: no limit; double-click the operation to change it</source>
   <translation>Größter Bahnabstand, 0: keine Grenze; zum Ändern die Operation doppelt anklicken</translation>
  </message>
  <message>
   <source>Method by which tool axes are found</source>
   <translation>Verfahren, nach dem die Werkzeugachsen gefunden werden</translation>
  </message>
  <message>
   <source>Minimum lean of ball ends from the normal</source>
   <translation>Kleinster Anstellwinkel von Kugelfräsern zur Normalen</translation>
  </message>
  <message>
   <source>Name in the library, or file</source>
   <translation>Name in der Bibliothek, oder Datei</translation>
  </message>
  <message>
   <source>Name of the tool in the shop</source>
   <translation>Name des Werkzeugs in der Werkstatt</translation>
  </message>
  <message>
   <source>Not checked for collisions, because it was not given</source>
   <translation>Nicht auf Kollision geprüft, weil es nicht angegeben war</translation>
  </message>
  <message>
   <source>Number of orientations</source>
   <translation>Zahl der Orientierungen</translation>
  </message>
  <message>
   <source>Number of passes</source>
   <translation>Zahl der Bahnen</translation>
  </message>
  <message>
   <source>Number of sub-surfaces</source>
   <translation>Zahl der Teilflächen</translation>
  </message>
  <message>
   <source>Number of the blade</source>
   <translation>Nummer der Schaufel</translation>
  </message>
  <message>
   <source>One line for this many points of the cutting moves</source>
   <translation>Eine Linie für so viele Punkte der Schnittbewegungen</translation>
  </message>
  <message>
   <source>Origin of the work coordinates: stock:top, part:top-front-left or point:X,Y,Z; nothing: that of the part</source>
   <translation>Nullpunkt der Werkstückkoordinaten: stock:top, part:top-front-left oder point:X,Y,Z; nichts: Ursprung des Teils</translation>
  </message>
  <message>
   <source>Other jobs that have the same work offset</source>
   <translation>Andere Aufträge mit derselben Nullpunktverschiebung</translation>
  </message>
  <message>
   <source>Out of date: the part or the inputs have changed since; recompute the operation</source>
   <translation>Veraltet: Das Teil oder die Eingaben haben sich seither geändert; die Operation neu berechnen</translation>
  </message>
  <message>
   <source>Out of date: the part or the inputs have changed since; recompute the plan</source>
   <translation>Veraltet: Das Teil oder die Eingaben haben sich seither geändert; den Plan neu berechnen</translation>
  </message>
  <message>
   <source>Outcome: complete, incomplete or cancelled</source>
   <translation>Ergebnis: complete (vollständig), incomplete (unvollständig) oder cancelled (abgebrochen)</translation>
  </message>
  <message>
   <source>Outcome: optimal, feasible, infeasible, not_found or cancelled</source>
   <translation>Ergebnis: optimal, feasible (machbar), infeasible (unmöglich), not_found (nicht gefunden) oder cancelled (abgebrochen)</translation>
  </message>
  <message>
   <source>Parameter that varies along the passes, u or v</source>
   <translation>Parameter, der sich entlang der Bahnen ändert, u oder v</translation>
  </message>
  <message>
   <source>Passes along parameters of the face, in parallel planes, or following the scallop height</source>
   <translation>Bahnen entlang der Parameter der Fläche, in parallelen Ebenen oder der Rillenhöhe folgend</translation>
  </message>
  <message>
   <source>Place of the tool in the magazine; 0: none</source>
   <translation>Platz des Werkzeugs im Magazin; 0: keiner</translation>
  </message>
  <message>
   <source>Plan of the setup before this one; nothing: this is the first setup</source>
   <translation>Plan der Aufspannung vor dieser; leer: dies ist die erste Aufspannung</translation>
  </message>
  <message>
   <source>Plan one blade of a part with blades and copy it to the others</source>
   <translation>Eine Schaufel eines Teils mit Schaufeln planen und auf die anderen übertragen</translation>
  </message>
  <message>
   <source>Points with the deepest gouges, in the frame of the plane</source>
   <translation>Stellen mit den tiefsten Konturverletzungen, im Koordinatensystem der Ebene</translation>
  </message>
  <message>
   <source>Points with the highest scallops, in the frame of the plane</source>
   <translation>Stellen mit den höchsten Rillen, im Koordinatensystem der Ebene</translation>
  </message>
  <message>
   <source>Position along the passes, 0 to 1</source>
   <translation>Position entlang der Bahnen, 0 bis 1</translation>
  </message>
  <message>
   <source>Position of the document's origin on the table, all axes at zero</source>
   <translation>Lage des Ursprungs des Dokuments auf dem Tisch, alle Achsen auf null</translation>
  </message>
  <message>
   <source>Positions of the rotary axes in both solutions, the one used first</source>
   <translation>Stellungen der Drehachsen in beiden Lösungen, die verwendete zuerst</translation>
  </message>
  <message>
   <source>Quantity shown by the colours</source>
   <translation>Größe, die die Farben zeigen</translation>
  </message>
  <message>
   <source>Quantity that the choice of the tool axis minimises</source>
   <translation>Größe, nach deren kleinstem Wert die Werkzeugachse gewählt wird</translation>
  </message>
  <message>
   <source>Radius of lead-in and lead-out arcs, 0: straight ramps; double-click the operation to change it</source>
   <translation>Radius der Bögen zum An- und Abfahren, 0: gerade Rampen; zum Ändern die Operation doppelt anklicken</translation>
  </message>
  <message>
   <source>Reasons that limit the choice of the axis, or why there is none</source>
   <translation>Gründe, die die Wahl der Achse begrenzen, oder warum es keine gibt</translation>
  </message>
  <message>
   <source>Result of Verify: not verified, passed, failed, or out of date</source>
   <translation>Ergebnis der Prüfung: not verified (nicht geprüft), passed (bestanden), failed (nicht bestanden) oder out of date (veraltet)</translation>
  </message>
  <message>
   <source>Rotation about the wheel's axis, in the part's own frame</source>
   <translation>Drehung um die Achse des Rads, im Koordinatensystem des Teils</translation>
  </message>
  <message>
   <source>Share of the area left as rest material</source>
   <translation>Anteil der Fläche, der als Restmaterial stehen bleibt</translation>
  </message>
  <message>
   <source>Share of the area within 1.02 times the scallop height, rest material excluded</source>
   <translation>Anteil der Fläche innerhalb der 1,02-fachen Rillenhöhe, ohne Restmaterial</translation>
  </message>
  <message>
   <source>Source of its data</source>
   <translation>Herkunft ihrer Daten</translation>
  </message>
  <message>
   <source>Spindle speed, rev/min</source>
   <translation>Drehzahl, U/min</translation>
  </message>
  <message>
   <source>State of part and operation that the passes were made for</source>
   <translation>Stand von Teil und Operation, für den die Bahnen gemacht wurden</translation>
  </message>
  <message>
   <source>Sub-surfaces of each face: a number, auto, or nothing for whole faces</source>
   <translation>Teilflächen jeder Fläche: eine Zahl, auto, oder nichts für ganze Flächen</translation>
  </message>
  <message>
   <source>The axis is kept when the operation is computed again</source>
   <translation>Die Achse bleibt, wenn die Operation neu berechnet wird</translation>
  </message>
  <message>
   <source>The border is kept when the plan is computed again</source>
   <translation>Die Grenze bleibt, wenn der Plan neu berechnet wird</translation>
  </message>
  <message>
   <source>The colours in words</source>
   <translation>Die Farben in Worten</translation>
  </message>
  <message>
   <source>The face of this blade</source>
   <translation>Die Fläche dieser Schaufel</translation>
  </message>
  <message>
   <source>The face that is machined</source>
   <translation>Die bearbeitete Fläche</translation>
  </message>
  <message>
   <source>The feed direction is kept when the operation is computed again</source>
   <translation>Die Vorschubrichtung bleibt, wenn die Operation neu berechnet wird</translation>
  </message>
  <message>
   <source>The operation of Tool Axis that the passes are from</source>
   <translation>Die Operation von Tool Axis, von der die Bahnen stammen</translation>
  </message>
  <message>
   <source>The passes of the tool</source>
   <translation>Die Bahnen des Werkzeugs</translation>
  </message>
  <message>
   <source>Their depths, mm</source>
   <translation>Ihre Tiefen, mm</translation>
  </message>
  <message>
   <source>Their heights, mm</source>
   <translation>Ihre Höhen, mm</translation>
  </message>
  <message>
   <source>This coordinate system in that of the part</source>
   <translation>Dieses Koordinatensystem in dem des Teils</translation>
  </message>
  <message>
   <source>Time of all operations, index moves included</source>
   <translation>Zeit aller Operationen mit Schwenkbewegungen</translation>
  </message>
  <message>
   <source>Time of passes and links</source>
   <translation>Zeit der Bahnen und Verbindungen</translation>
  </message>
  <message>
   <source>Tool axis from tip to spindle, as planned, in document coordinates</source>
   <translation>Werkzeugachse von der Spitze zur Spindel, wie geplant, in Koordinaten des Dokuments</translation>
  </message>
  <message>
   <source>Tool libraries, folders and tools to choose from; nothing: the tool above</source>
   <translation>Werkzeugbibliotheken, Ordner und Werkzeuge zur Auswahl; nichts: das Werkzeug oben</translation>
  </message>
  <message>
   <source>Tools with their operations and times</source>
   <translation>Werkzeuge mit ihren Operationen und Zeiten</translation>
  </message>
  <message>
   <source>Upper bound of the gouge in the machined faces</source>
   <translation>Obergrenze der Konturverletzung an den bearbeiteten Flächen</translation>
  </message>
  <message>
   <source>Value at the dark end of the colours</source>
   <translation>Wert am dunklen Ende der Farben</translation>
  </message>
  <message>
   <source>Value at the light end of the colours: the limit</source>
   <translation>Wert am hellen Ende der Farben: die Grenze</translation>
  </message>
  <message>
   <source>Warnings about the part</source>
   <translation>Warnungen zum Teil</translation>
  </message>
  <message>
   <source>What it shows</source>
   <translation>Was es zeigt</translation>
  </message>
  <message>
   <source>Where the axis moves: its mean lean from the normal, or its constant lead</source>
   <translation>Wo sich die Achse bewegt: ihr mittlerer Anstellwinkel zur Normalen oder ihr fester Voreilwinkel</translation>
  </message>
  <message>
   <source>Whether the axis moves while cutting; Axis is then its mean</source>
   <translation>Ob sich die Achse beim Schneiden bewegt; Axis ist dann ihr Mittel</translation>
  </message>
  <message>
   <source>Why it failed, and what was not checked</source>
   <translation>Warum nicht bestanden, und was nicht geprüft wurde</translation>
  </message>
 </context>
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
   <source>(out of date)</source>
   <translation>(veraltet)</translation>
  </message>
  <message>
   <source>, about {} s left</source>
   <translation>, noch etwa {} s</translation>
  </message>
  <message>
   <source>, short by {}</source>
   <translation>, es fehlen {}</translation>
  </message>
  <message>
   <source>A ball end goes around a blade in layers while one rotary axis swivels. Needs a ball end; of the faces around a blade one is enough.</source>
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
   <source>Allow any number of tools</source>
   <translation>Beliebig viele Werkzeuge zulassen</translation>
  </message>
  <message>
   <source>Area</source>
   <translation>Fläche</translation>
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
   <source>Checking all operations</source>
   <translation>Alle Operationen werden geprüft</translation>
  </message>
  <message>
   <source>Checking for collisions</source>
   <translation>Kollisionen werden geprüft</translation>
  </message>
  <message>
   <source>Choose a folder.</source>
   <translation>Bitte einen Ordner wählen.</translation>
  </message>
  <message>
   <source>Clamped in this setup: {}.</source>
   <translation>In dieser Aufspannung gespannt: {}.</translation>
  </message>
  <message>
   <source>Click a point: the plan is computed again with that many orientations.</source>
   <translation>Ein Klick auf einen Punkt: der Plan wird mit so vielen Orientierungen neu berechnet.</translation>
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
   <source>Collisions could not be checked: {}</source>
   <translation>Kollisionen konnten nicht geprüft werden: {}</translation>
  </message>
  <message>
   <source>Collisions: {} ({}).</source>
   <translation>Kollisionen: {} ({}).</translation>
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
   <source>Diameter</source>
   <translation>Durchmesser</translation>
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
   <source>Folder</source>
   <translation>Ordner</translation>
  </message>
  <message>
   <source>Folder for the pictures</source>
   <translation>Ordner für die Bilder</translation>
  </message>
  <message>
   <source>FreeCAD has mixed up this panel with one that was closed: open it once more, or restart FreeCAD</source>
   <translation>FreeCAD hat diesen Aufgabenbereich mit einem geschlossenen verwechselt: bitte noch einmal öffnen oder FreeCAD neu starten</translation>
  </message>
  <message>
   <source>FreeCAD's library {}</source>
   <translation>Bibliothek {} von FreeCAD</translation>
  </message>
  <message>
   <source>Gouge allowed</source>
   <translation>Erlaubte Konturverletzung</translation>
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
   <source>Holder clearance</source>
   <translation>Abstand des Halters</translation>
  </message>
  <message>
   <source>Index move from {} to {}: {}</source>
   <translation>Schwenkbewegung von {} nach {}: {}</translation>
  </message>
  <message>
   <source>Index move to {}</source>
   <translation>Schwenkbewegung zu {}</translation>
  </message>
  <message>
   <source>Inputs have changed: compute again.</source>
   <translation>Die Eingaben haben sich geändert: bitte neu berechnen.</translation>
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
   <source>Length against the number of orientations</source>
   <translation>Länge über der Anzahl der Orientierungen</translation>
  </message>
  <message>
   <source>Length and number of orientations</source>
   <translation>Länge und Zahl der Orientierungen</translation>
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
   <source>Machined in earlier setups: {}.</source>
   <translation>In früheren Aufspannungen bearbeitet: {}.</translation>
  </message>
  <message>
   <source>Machined within {}</source>
   <translation>Bearbeitet innerhalb {}</translation>
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
   <source>Max. gouge</source>
   <translation>Max. Konturverletzung</translation>
  </message>
  <message>
   <source>Max. scallop height</source>
   <translation>Max. Rillenhöhe</translation>
  </message>
  <message>
   <source>Mean lean</source>
   <translation>Mittlerer Anstellwinkel</translation>
  </message>
  <message>
   <source>Motion of the axes</source>
   <translation>Bewegung der Achsen</translation>
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
   <source>No map was kept of the axes tested: the reasons are listed below.</source>
   <translation>Von den geprüften Achsen wurde keine Karte behalten: die Gründe stehen darunter.</translation>
  </message>
  <message>
   <source>No map: no axis was tested.</source>
   <translation>Keine Karte: Es wurde keine Achse geprüft.</translation>
  </message>
  <message>
   <source>No map: the axis moves along the passes.</source>
   <translation>Keine Karte: Die Achse bewegt sich entlang der Bahnen.</translation>
  </message>
  <message>
   <source>No map: this axis was not searched for by itself. It is shared by sub-surfaces, given, or set by the method.</source>
   <translation>Keine Karte: Diese Achse wurde nicht für sich gesucht. Teilflächen haben sie gemeinsam, sie ist vorgegeben oder folgt aus dem Verfahren.</translation>
  </message>
  <message>
   <source>No possible axis.</source>
   <translation>Keine Achse möglich.</translation>
  </message>
  <message>
   <source>No usable position on this machine: {}</source>
   <translation>Auf dieser Maschine keine brauchbare Stellung: {}</translation>
  </message>
  <message>
   <source>No vertex is selected: select a vertex of the part in the 3D view</source>
   <translation>Kein Eckpunkt ist ausgewählt: in der 3D-Ansicht einen Eckpunkt des Teils auswählen</translation>
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
   <source>Orientations: {}; sub-surfaces: {}; {}</source>
   <translation>Orientierungen: {}; Teilflächen: {}; {}</translation>
  </message>
  <message>
   <source>Other methods</source>
   <translation>Andere Verfahren</translation>
  </message>
  <message>
   <source>Out of date: {}. Recompute</source>
   <translation>Veraltet: {}. Neu berechnen</translation>
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
   <translation>Auf Berechnen drücken, um die Achsen zu suchen.</translation>
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
   <source>Recompute</source>
   <translation>Neu berechnen</translation>
  </message>
  <message>
   <source>Remove axis limits</source>
   <translation>Grenzen der Achse aufheben</translation>
  </message>
  <message>
   <source>Removing material</source>
   <translation>Material wird abgetragen</translation>
  </message>
  <message>
   <source>Rest material</source>
   <translation>Restmaterial</translation>
  </message>
  <message>
   <source>Rest material {}</source>
   <translation>Restmaterial {}</translation>
  </message>
  <message>
   <source>Results are up to date; Verify: {}</source>
   <translation>Die Ergebnisse sind aktuell; Prüfung: {}</translation>
  </message>
  <message>
   <source>Roman's rule</source>
   <translation>Regel von Roman</translation>
  </message>
  <message>
   <source>Rotating axis</source>
   <translation>Drehende Achse</translation>
  </message>
  <message>
   <source>Rotation about Z</source>
   <translation>Drehung um Z</translation>
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
   <translation>Erlaubte Rillenhöhe</translation>
  </message>
  <message>
   <source>Select a vertex of the part in the 3D view and press Use selected on the tab Setup</source>
   <translation>In der 3D-Ansicht einen Eckpunkt des Teils auswählen und auf dem Reiter Aufspannung „Auswahl nehmen“ drücken</translation>
  </message>
  <message>
   <source>Select one or more faces in the 3D view and press Add selected</source>
   <translation>Bitte eine oder mehrere Flächen in der 3D-Ansicht auswählen und Auswahl hinzufügen drücken</translation>
  </message>
  <message>
   <source>Select one sub-surface in the tree. To split it elsewhere than in the middle, also select a line across it.</source>
   <translation>Bitte eine Teilfläche im Baum auswählen. Um sie anderswo als in der Mitte zu zerteilen, auch eine Linie quer darüber auswählen.</translation>
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
   <source>The axis leans by a constant angle from the normal, along the feed.</source>
   <translation>Die Achse ist um einen festen Winkel gegen die Normale geneigt, in Vorschubrichtung.</translation>
  </message>
  <message>
   <source>The axis moves along the passes: lines in the 3D view show it.</source>
   <translation>Die Achse bewegt sich entlang der Bahnen: Linien in der 3D-Ansicht zeigen sie.</translation>
  </message>
  <message>
   <source>The cutter touches the face at two points where it is concave. Needs a flat end mill or bull nose.</source>
   <translation>Der Fräser berührt die Fläche an zwei Punkten, wo sie konkav ist. Braucht einen Schaft- oder Torusfräser.</translation>
  </message>
  <message>
   <source>The document was not changed. Please report the error with the copied details and, if you can, the part.</source>
   <translation>Das Dokument wurde nicht verändert. Bitte melden Sie den Fehler mit den kopierten Einzelheiten und, wenn möglich, dem Teil.</translation>
  </message>
  <message>
   <source>The earlier setup was deleted: choose another one, or none</source>
   <translation>Die frühere Aufspannung wurde gelöscht: eine andere wählen, oder keine</translation>
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
   <source>The operations were deleted: there is no tool axis to reach</source>
   <translation>Die Operationen wurden gelöscht: es ist keine Werkzeugachse zu erreichen</translation>
  </message>
  <message>
   <source>The operations were deleted: there is nothing to export</source>
   <translation>Die Operationen wurden gelöscht: nichts zu exportieren</translation>
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
   <source>The result of Verify could not be saved: {}</source>
   <translation>Das Prüfergebnis konnte nicht gespeichert werden: {}</translation>
  </message>
  <message>
   <source>The tool alone: choose a machine with Tool Axis &gt; Machine to see it and its index moves</source>
   <translation>Nur das Werkzeug: mit Tool Axis &gt; Maschine eine Maschine wählen, um sie und ihre Schwenkbewegungen zu sehen</translation>
  </message>
  <message>
   <source>The vertex does not belong to the part to machine: select one of {}</source>
   <translation>Der Eckpunkt gehört nicht zum bearbeiteten Teil: einen von {} auswählen</translation>
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
   <source>There is no planned operation to export: select faces and run Plan Orientations first.</source>
   <translation>Es gibt keine geplante Operation zum Exportieren: bitte Flächen auswählen und zuerst Orientierungen planen.</translation>
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
   <translation>Es gibt keine geplante Operation zum Neuberechnen: bitte Flächen auswählen und zuerst Orientierungen planen.</translation>
  </message>
  <message>
   <source>There is no planned operation to verify: select faces and run Plan Orientations first.</source>
   <translation>Es gibt keine geplante Operation zum Prüfen: bitte Flächen auswählen und zuerst Orientierungen planen.</translation>
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
   <source>Tool change and index move to {}</source>
   <translation>Werkzeugwechsel und Schwenkbewegung zu {}</translation>
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
   <source>Two-point contact</source>
   <translation>Zwei-Punkt-Kontakt</translation>
  </message>
  <message>
   <source>Use fixed axes</source>
   <translation>Feste Achsen verwenden</translation>
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
   <source>Work coordinates {}</source>
   <translation>Werkstückkoordinaten {}</translation>
  </message>
  <message>
   <source>above {}</source>
   <translation>über {}</translation>
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
   <source>checking for gouges and collisions</source>
   <translation>Konturverletzungen und Kollisionen werden geprüft</translation>
  </message>
  <message>
   <source>chosen axis</source>
   <translation>gewählte Achse</translation>
  </message>
  <message>
   <source>chosen axis: strip width {}, {} passes computed</source>
   <translation>gewählte Achse: Streifenbreite {}, {} Bahnen berechnet</translation>
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
   <source>feasible</source>
   <translation>machbar</translation>
  </message>
  <message>
   <source>folder of tools...</source>
   <translation>Ordner mit Werkzeugen...</translation>
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
   <source>no faces</source>
   <translation>keine Flächen</translation>
  </message>
  <message>
   <source>no other body in the document</source>
   <translation>kein anderer Körper im Dokument</translation>
  </message>
  <message>
   <source>no points</source>
   <translation>keine Stellen</translation>
  </message>
  <message>
   <source>no position reaches it</source>
   <translation>keine Stellung erreicht sie</translation>
  </message>
  <message>
   <source>no program</source>
   <translation>kein Programm</translation>
  </message>
  <message>
   <source>no vertex</source>
   <translation>kein Eckpunkt</translation>
  </message>
  <message>
   <source>none</source>
   <translation>keine</translation>
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
   <source>not possible: {}{}, {}</source>
   <translation>nicht möglich: {}{}, {}</translation>
  </message>
  <message>
   <source>not reached</source>
   <translation>nicht erreicht</translation>
  </message>
  <message>
   <source>nothing near</source>
   <translation>nichts in der Nähe</translation>
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
   <source>orientations</source>
   <translation>Orientierungen</translation>
  </message>
  <message>
   <source>orientations: {}</source>
   <translation>Orientierungen: {}</translation>
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
   <source>rest material</source>
   <translation>Restmaterial</translation>
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
   <translation>Flächenverbände: {} aus {} Flächen, {}</translation>
  </message>
  <message>
   <source>strip width, estimated</source>
   <translation>Streifenbreite, geschätzt</translation>
  </message>
  <message>
   <source>tool changes and index moves</source>
   <translation>Werkzeugwechsel und Schwenkbewegungen</translation>
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
   <source>{} Collisions with the part could not be checked: {}</source>
   <translation>{} Kollisionen mit dem Teil konnten nicht geprüft werden: {}</translation>
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
   <source>{} is out of date: {}. Recompute it.</source>
   <translation>{} ist veraltet: {}. Bitte neu berechnen.</translation>
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
   <source>{} of {} faces have an axis, {} are left as rest material, {} have none; the reasons are on the tab Axis.</source>
   <translation>{} von {} Flächen haben eine Achse, {} bleiben als Restmaterial stehen, {} haben keine; die Gründe stehen auf dem Reiter Achse.</translation>
  </message>
  <message>
   <source>{} of {} faces have an axis, {} are left as rest material. {} OK puts them into the document.</source>
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
   <source>{} of {}, as in the earlier setup</source>
   <translation>{} von {}, wie in der früheren Aufspannung</translation>
  </message>
  <message>
   <source>{} of {}: cutting {}, non-cutting {}</source>
   <translation>{} von {}: Schnitt {}, Nebenzeit {}</translation>
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
   <translation>{}: Anfahren, Bahn {} von {}</translation>
  </message>
  <message>
   <source>{}: lead-out, pass {} of {}</source>
   <translation>{}: Abfahren, Bahn {} von {}</translation>
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
   <source>{}: no axis tested yet</source>
   <translation>{}: noch keine Achse geprüft</translation>
  </message>
  <message>
   <source>{}: not begun</source>
   <translation>{}: nicht begonnen</translation>
  </message>
  <message>
   <source>{}: rest material</source>
   <translation>{}: Restmaterial</translation>
  </message>
  <message>
   <source>{}: the axes tested so far</source>
   <translation>{}: die bisher geprüften Achsen</translation>
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
   <source>Machine that the program is for: the program contains its rotary angles.</source>
   <translation>Maschine, für die das Programm ist: Es enthält deren Drehwinkel.</translation>
  </message>
  <message>
   <source>NC program besides plan.json and the CL files, with its setup sheet.</source>
   <translation>NC-Programm neben plan.json und den CL-Dateien, mit Einrichteblatt.</translation>
  </message>
  <message>
   <source>Opens the planning panel with this machine and this position on its table, and computes: axes, passes and collisions are then those of the machine.</source>
   <translation>Öffnet die Planung mit dieser Maschine und diesem Platz auf ihrem Tisch und rechnet: Achsen, Bahnen und Kollisionen sind dann die der Maschine.</translation>
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
   <source>Sets the part higher on the table, in Z of its origin, and writes. This may help: check the new program.</source>
   <translation>Setzt das Teil auf dem Tisch höher, in Z seines Ursprungs, und schreibt. Das kann helfen: das neue Programm prüfen.</translation>
  </message>
  <message>
   <source>Stop</source>
   <translation>Stopp</translation>
  </message>
  <message>
   <source>Stops; the folder stays as it is.</source>
   <translation>Stoppt; der Ordner bleibt, wie er ist.</translation>
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
   <source>Keep the machine bed still</source>
   <translation>Maschinenbett steht still</translation>
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
   <translation>Bewegt das Werkzeug entlang der Bahnen aller Operationen.</translation>
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
   <source>Playback speed, as a multiple of real time.</source>
   <translation>Abspielgeschwindigkeit als Vielfaches der Echtzeit.</translation>
  </message>
  <message>
   <source>Plays all operations in their order, with the index moves between them.</source>
   <translation>Spielt alle Operationen in ihrer Reihenfolge ab, mit den Schwenkbewegungen dazwischen.</translation>
  </message>
  <message>
   <source>Positions of the rotary axes for each operation, in both solutions. Click one to see it.</source>
   <translation>Stellungen der Drehachsen bei jeder Operation, in beiden Lösungen. Ein Klick zeigt die Lösung.</translation>
  </message>
  <message>
   <source>The camera stays with the machine's bed, so that the table rotates; otherwise it stays with the part.</source>
   <translation>Die Kamera bleibt beim Maschinenbett, so dass sich der Tisch dreht; sonst bleibt sie beim Teil.</translation>
  </message>
  <message>
   <source>The machine whose rotary axes have to reach the tool axes. Its ranges, travels and bodies are checked for every operation.</source>
   <translation>Die Maschine, deren Drehachsen die Werkzeugachsen erreichen müssen. Ihre Bereiche, Verfahrwege und Körper werden für jede Operation geprüft.</translation>
  </message>
  <message>
   <source>Time so far and in total, split into cutting and non-cutting: lead-ins, lead-outs, links, index moves and tool changes.</source>
   <translation>Bisherige und gesamte Zeit, aufgeteilt in Schnitt und Nebenzeit: An- und Abfahren, Verbindungen, Schwenkbewegungen und Werkzeugwechsel.</translation>
  </message>
  <message>
   <source>Two rotary axes reach almost every tool axis in two positions. The bold one is used: closest to the previous operation, inside all ranges and travels, and without collisions. Problems are listed below the angles.</source>
   <translation>Zwei Drehachsen erreichen fast jede Werkzeugachse in zwei Stellungen. Verwendet wird die fett gedruckte: der vorigen Operation am nächsten, innerhalb aller Bereiche und Verfahrwege und ohne Kollision. Probleme stehen unter den Winkeln.</translation>
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
   <source>Results of the axis of the operation.</source>
   <translation>Ergebnisse der Achse der Operation.</translation>
  </message>
  <message>
   <source>Shows pictures of the plan in a window: passes, contacts, angles and axis motion.</source>
   <translation>Zeigt Bilder des Plans in einem Fenster: Bahnen, Kontakte, Winkel und Achsbewegungen.</translation>
  </message>
  <message>
   <source>Tool position</source>
   <translation>Werkzeugposition</translation>
  </message>
  <message>
   <source>Verify</source>
   <translation>Prüfen</translation>
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
   <source>Along parameters: along the parameter lines of the face.
In parallel planes: in planes that contain the tool axis.
Following the scallop height: passes as far apart as their strips are wide.
Whichever is shorter: the first or the third of these.
All but the first need fixed axes.</source>
   <translation>Entlang der Parameter: entlang der Parameterlinien der Fläche.
In parallelen Ebenen: in Ebenen, in denen die Werkzeugachse liegt.
Der Rillenhöhe folgend: Bahnen so weit auseinander, wie ihre Streifen breit sind.
Die kürzeren von beiden: die erste oder die dritte dieser Arten.
Alle außer der ersten brauchen feste Achsen.</translation>
  </message>
  <message>
   <source>Also plans the same faces by other methods, and lists their results.</source>
   <translation>Plant dieselben Flächen auch mit anderen Verfahren und stellt die Ergebnisse nebeneinander.</translation>
  </message>
  <message>
   <source>Angle between the side of the cutter and its axis.</source>
   <translation>Winkel zwischen dem Mantel des Fräsers und seiner Achse.</translation>
  </message>
  <message>
   <source>Avoid faces</source>
   <translation>Flächen meiden</translation>
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
   <translation>Kugelfräser</translation>
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
   <source>Clamped side</source>
   <translation>Gespannte Seite</translation>
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
   <source>Cone axis, X: the middle of the allowed tool axes.</source>
   <translation>Kegelachse, X: die Mitte der erlaubten Werkzeugachsen.</translation>
  </message>
  <message>
   <source>Cone axis, Y: the middle of the allowed tool axes.</source>
   <translation>Kegelachse, Y: die Mitte der erlaubten Werkzeugachsen.</translation>
  </message>
  <message>
   <source>Cone axis, Z: the middle of the allowed tool axes.</source>
   <translation>Kegelachse, Z: die Mitte der erlaubten Werkzeugachsen.</translation>
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
   <source>Earlier setup</source>
   <translation>Frühere Aufspannung</translation>
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
   <source>Feed and speed</source>
   <translation>Vorschub und Drehzahl</translation>
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
   <source>Feed rate of the cutting moves.</source>
   <translation>Vorschub der Schnittbewegungen.</translation>
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
   <source>How the axis of each sub-surface is found; highest axis jerk needs a machine; the methods below it are for comparison.</source>
   <translation>Wie die Achse jeder Teilfläche gefunden wird; höchste Achsdynamik braucht eine Maschine; die Verfahren darunter dienen dem Vergleich.</translation>
  </message>
  <message>
   <source>If all faces of a part with blades are chosen, one blade is planned. Its operations are rotated to the other blades and proven there.</source>
   <translation>Sind alle Flächen eines Teils mit Schaufeln gewählt, wird eine Schaufel geplant. Ihre Operationen werden auf die anderen Schaufeln gedreht und dort nachgewiesen.</translation>
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
   <source>Left by roughing</source>
   <translation>Schruppaufmaß</translation>
  </message>
  <message>
   <source>Length of the cutting edge from the tip; above it the shank begins. 0: two diameters, as far as the stick-out allows.</source>
   <translation>Länge der Schneide von der Spitze an; darüber beginnt der Schaft. 0: zwei Durchmesser, soweit die Auskraglänge reicht.</translation>
  </message>
  <message>
   <source>Lists all faces, those in sight in the 3D view, or those hidden there. Hidden: the body is not shown, or other faces cover the face. The list follows the view.</source>
   <translation>Listet alle Flächen auf, die in der 3D-Ansicht sichtbaren oder die dort verdeckten. Verdeckt: Der Körper ist ausgeblendet, oder andere Flächen liegen davor. Die Liste folgt der Ansicht.</translation>
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
   <translation>Zugaben des Rohteils</translation>
  </message>
  <message>
   <source>Material to leave on the faces.</source>
   <translation>Material, das auf den Flächen stehen bleiben soll.</translation>
  </message>
  <message>
   <source>Max. angle</source>
   <translation>Max. Winkel</translation>
  </message>
  <message>
   <source>Max. step-over</source>
   <translation>Max. Bahnabstand</translation>
  </message>
  <message>
   <source>Maximum angle between the tool axis and the cone axis.</source>
   <translation>Größter Winkel zwischen Werkzeugachse und Kegelachse.</translation>
  </message>
  <message>
   <source>Maximum azimuth of the tool axis about the cone axis.</source>
   <translation>Größter Azimut der Werkzeugachse um die Kegelachse.</translation>
  </message>
  <message>
   <source>Maximum distance between neighbouring passes, whatever the scallop height allows; 0 = no limit.</source>
   <translation>Größter Abstand benachbarter Bahnen, was auch immer die Rillenhöhe zulässt; 0 = keine Grenze.</translation>
  </message>
  <message>
   <source>Maximum height left between neighbouring passes.</source>
   <translation>Größte Höhe, die zwischen benachbarten Bahnen stehen bleibt.</translation>
  </message>
  <message>
   <source>Maximum number of orientations.</source>
   <translation>Größte Zahl der Orientierungen.</translation>
  </message>
  <message>
   <source>Maximum number of tools used from the rack.</source>
   <translation>So viele Werkzeuge des Magazins werden höchstens eingesetzt.</translation>
  </message>
  <message>
   <source>Maximum roughness across the feed.</source>
   <translation>Größte Rauheit quer zum Vorschub.</translation>
  </message>
  <message>
   <source>Method</source>
   <translation>Verfahren</translation>
  </message>
  <message>
   <source>Min. lean</source>
   <translation>Min. Anstellwinkel</translation>
  </message>
  <message>
   <source>Minimise</source>
   <translation>Minimieren</translation>
  </message>
  <message>
   <source>Minimum angle between the tool axis and the cone axis.</source>
   <translation>Kleinster Winkel zwischen Werkzeugachse und Kegelachse.</translation>
  </message>
  <message>
   <source>Minimum angle of ball ends to the normal of the face, so that the tip does not cut; 0 = no limit.</source>
   <translation>Kleinster Winkel von Kugelfräsern zur Flächennormalen, damit die Spitze nicht schneidet; 0 = keine Grenze.</translation>
  </message>
  <message>
   <source>Minimum azimuth of the tool axis about the cone axis.</source>
   <translation>Kleinster Azimut der Werkzeugachse um die Kegelachse.</translation>
  </message>
  <message>
   <source>Moves the tool along the passes of all operations.</source>
   <translation>Bewegt das Werkzeug entlang der Bahnen aller Operationen.</translation>
  </message>
  <message>
   <source>Moves tool and holder along the passes.</source>
   <translation>Bewegt Werkzeug und Halter entlang der Bahnen.</translation>
  </message>
  <message>
   <source>Number of orientations in all; automatic: every number is tried, and a curve shows the result of each.</source>
   <translation>Zahl der Orientierungen insgesamt; automatisch: jede Anzahl wird versucht, und eine Kurve zeigt die Ergebnisse.</translation>
  </message>
  <message>
   <source>Number of sub-surfaces of each face.</source>
   <translation>Zahl der Teilflächen jeder Fläche.</translation>
  </message>
  <message>
   <source>Number of sub-surfaces of each face; automatic: as many as save more than their index moves cost, around bosses too.</source>
   <translation>Zahl der Teilflächen jeder Fläche; automatisch: so viele, wie sich trotz ihrer Schwenkbewegungen lohnen, auch um Zapfen herum.</translation>
  </message>
  <message>
   <source>Numbers of faces of the part that no tool may touch.</source>
   <translation>Nummern von Flächen des Teils, die kein Werkzeug berühren darf.</translation>
  </message>
  <message>
   <source>OK and plan the next setup</source>
   <translation>OK und nächste Aufspannung planen</translation>
  </message>
  <message>
   <source>One tool, or a rack to choose from: large tools begin, smaller ones finish what they leave.</source>
   <translation>Ein Werkzeug, oder ein Magazin zur Auswahl: Große beginnen, kleinere bearbeiten, was sie übrig lassen.</translation>
  </message>
  <message>
   <source>Orientations</source>
   <translation>Orientierungen</translation>
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
   <source>Plan of the setup before this one. Only what it leaves of its faces is machined: what was clamped there and what stayed open.</source>
   <translation>Plan der Aufspannung vor dieser. Nur was sie von ihren Flächen übrig lässt, wird bearbeitet: was dort gespannt war und was offen blieb.</translation>
  </message>
  <message>
   <source>Plan one blade, copy to others</source>
   <translation>Eine Schaufel planen und übertragen</translation>
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
   <source>Playback speed, as a multiple of real time.</source>
   <translation>Abspielgeschwindigkeit als Vielfaches der Echtzeit.</translation>
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
   <source>Puts this plan into the document and plans the next setup: only what this one leaves is machined there.</source>
   <translation>Übernimmt diesen Plan ins Dokument und plant die nächste Aufspannung: dort wird nur bearbeitet, was diese übrig lässt.</translation>
  </message>
  <message>
   <source>Quantity that the choice of the tool axis minimises.</source>
   <translation>Größe, nach deren kleinstem Wert die Werkzeugachse gewählt wird.</translation>
  </message>
  <message>
   <source>Radius of the arcs on which the tool enters and leaves passes, wherever these are proven free; 0 = straight ramps.</source>
   <translation>Radius der Bögen, auf denen das Werkzeug an Bahnen an- und von ihnen abfährt, wo sie nachweislich frei sind; 0 = gerade Rampen.</translation>
  </message>
  <message>
   <source>Radius of the rounded corner.</source>
   <translation>Radius der gerundeten Ecke.</translation>
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
   <source>Results of the axis, and beside them those of the axis tried.</source>
   <translation>Ergebnisse der Achse, daneben die der ausprobierten.</translation>
  </message>
  <message>
   <source>Roman's rule</source>
   <translation>Regel von Roman</translation>
  </message>
  <message>
   <source>Roughing stock and faces</source>
   <translation>Schruppaufmaß und Flächen</translation>
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
   <source>Searches for the axes of the faces with the settings of the tabs; nothing enters the document yet.</source>
   <translation>Sucht die Achsen der Flächen mit den Einstellungen der Reiter; ins Dokument kommt noch nichts.</translation>
  </message>
  <message>
   <source>Sets this in the fields and computes again. This may help: check the new result.</source>
   <translation>Trägt dies in die Felder ein und rechnet neu. Das kann helfen: das neue Ergebnis prüfen.</translation>
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
   <source>Spindle speed</source>
   <translation>Drehzahl</translation>
  </message>
  <message>
   <source>Spindle speed.</source>
   <translation>Spindeldrehzahl.</translation>
  </message>
  <message>
   <source>Stick-out</source>
   <translation>Auskraglänge</translation>
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
   <source>Stops the computation; results of faces finished by then are kept.</source>
   <translation>Stoppt die Berechnung; Ergebnisse bis dahin fertiger Flächen bleiben.</translation>
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
   <translation>Nimmt den in der 3D-Ansicht ausgewählten Eckpunkt als Nullpunkt. Er bewegt sich mit dem Teil.</translation>
  </message>
  <message>
   <source>Taper half angle</source>
   <translation>Halber Kegelwinkel</translation>
  </message>
  <message>
   <source>Tapered</source>
   <translation>Konischer Fräser</translation>
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
   <translation>Der Punkt des Quaders. Der Quader liegt entlang X, Y und Z des Dokuments: links ist -X, vorn ist -Y.</translation>
  </message>
  <message>
   <source>The rest of the part and ticked bodies are always avoided.</source>
   <translation>Der Rest des Teils und angekreuzte Körper werden immer gemieden.</translation>
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
   <source>Time so far and in total, split into cutting and non-cutting: lead-ins, lead-outs, links, index moves and tool changes.</source>
   <translation>Bisherige und gesamte Zeit, aufgeteilt in Schnitt und Nebenzeit: An- und Abfahren, Verbindungen, Schwenkbewegungen und Werkzeugwechsel.</translation>
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
   <translation>Werkzeugposition</translation>
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
   <source>What the part is cut from: it goes into CAM jobs and onto the setup sheet.</source>
   <translation>Woraus das Teil gefräst wird: steht in den CAM-Aufträgen und auf dem Einrichteblatt.</translation>
  </message>
  <message>
   <source>Whether the tool axis stands still while it cuts, or how it moves.</source>
   <translation>Ob die Werkzeugachse beim Schneiden stillsteht, oder wie sie sich bewegt.</translation>
  </message>
  <message>
   <source>Zero point of work coordinate systems, jobs and programs.</source>
   <translation>Nullpunkt der Werkstückkoordinatensysteme, Aufträge und Programme.</translation>
  </message>
  <message>
   <source>all faces</source>
   <translation>alle Flächen</translation>
  </message>
  <message>
   <source>along parameters</source>
   <translation>entlang der Parameter</translation>
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
   <source>any, tilt and azimuth limited</source>
   <translation>beliebig, Neigung, Azimut begrenzt</translation>
  </message>
  <message>
   <source>as the CAM job makes it</source>
   <translation>wie der CAM-Auftrag es anlegt</translation>
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
   <translation>Quader mit Zugaben</translation>
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
   <source>hidden</source>
   <translation>verdeckte</translation>
  </message>
  <message>
   <source>highest axis jerk along passes</source>
   <translation>höchste Achsdynamik (Ruck) entlang der Bahnen</translation>
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
   <source>selected vertex</source>
   <translation>ausgewählter Eckpunkt</translation>
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
   <translation>Zwei-Punkt-Kontakt</translation>
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
   <source>Keep the machine bed still</source>
   <translation>Maschinenbett steht still</translation>
  </message>
  <message>
   <source>Moves the tool along the passes of all operations.</source>
   <translation>Bewegt das Werkzeug entlang der Bahnen aller Operationen.</translation>
  </message>
  <message>
   <source>Play</source>
   <translation>Abspielen</translation>
  </message>
  <message>
   <source>Playback speed, as a multiple of real time.</source>
   <translation>Abspielgeschwindigkeit als Vielfaches der Echtzeit.</translation>
  </message>
  <message>
   <source>Plays all operations in their order, with the index moves between them.</source>
   <translation>Spielt alle Operationen in ihrer Reihenfolge ab, mit den Schwenkbewegungen dazwischen.</translation>
  </message>
  <message>
   <source>The camera stays with the machine's bed, so that the table rotates; otherwise it stays with the part.</source>
   <translation>Die Kamera bleibt beim Maschinenbett, so dass sich der Tisch dreht; sonst bleibt sie beim Teil.</translation>
  </message>
  <message>
   <source>Time so far and in total, split into cutting and non-cutting: lead-ins, lead-outs, links, index moves and tool changes.</source>
   <translation>Bisherige und gesamte Zeit, aufgeteilt in Schnitt und Nebenzeit: An- und Abfahren, Verbindungen, Schwenkbewegungen und Werkzeugwechsel.</translation>
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
   <source>Colour of the cutting moves.</source>
   <translation>Farbe der Schnittbewegungen.</translation>
  </message>
  <message>
   <source>Colour of the links between passes.</source>
   <translation>Farbe der Verbindungen zwischen den Bahnen.</translation>
  </message>
  <message>
   <source>Computing</source>
   <translation>Rechnen</translation>
  </message>
  <message>
   <source>Cutting moves</source>
   <translation>Schnittbewegungen</translation>
  </message>
  <message>
   <source>Feed rate</source>
   <translation>Vorschub</translation>
  </message>
  <message>
   <source>Feed rate of the cutting moves.</source>
   <translation>Vorschub der Schnittbewegungen.</translation>
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
   <source>Maximum height left between neighbouring passes.</source>
   <translation>Größte Höhe, die zwischen benachbarten Bahnen stehen bleibt.</translation>
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
   <source>Spindle speed</source>
   <translation>Drehzahl</translation>
  </message>
  <message>
   <source>Spindle speed.</source>
   <translation>Spindeldrehzahl.</translation>
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
   <source>Toolpath colours</source>
   <translation>Farben der Bahnen</translation>
  </message>
  <message>
   <source>automatic (from the part)</source>
   <translation>automatisch (nach dem Teil)</translation>
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
   <source>Removes material along the passes and measures what is left.</source>
   <translation>Trägt Material entlang der Bahnen ab und misst, was bleibt.</translation>
  </message>
  <message>
   <source>Show</source>
   <translation>Anzeige</translation>
  </message>
  <message>
   <source>Stop</source>
   <translation>Stopp</translation>
  </message>
  <message>
   <source>Stops verification.</source>
   <translation>Stoppt die Prüfung.</translation>
  </message>
  <message>
   <source>Verify</source>
   <translation>Prüfen</translation>
  </message>
  <message>
   <source>What Verify measured, and what is allowed.</source>
   <translation>Was die Prüfung gemessen hat, und was erlaubt ist.</translation>
  </message>
  <message>
   <source>What the colours on the face show.</source>
   <translation>Was die Farben auf der Fläche zeigen.</translation>
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
   <translation>Hyperbolisches Paraboloid entlang seiner Erzeugenden</translation>
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
   <translation>Flächenverband aus sechs Flächen</translation>
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
   <source>Selects a machine and shows the positions of its rotary axes for each operation, and its index moves</source>
   <translation>Wählt eine Maschine und zeigt die Stellungen ihrer Drehachsen bei jeder Operation und ihre Schwenkbewegungen</translation>
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
   <source>Merges the selected sub-surfaces of a face and plans them again</source>
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
   <source>Split Sub-Surface</source>
   <translation>Teilfläche zerteilen</translation>
  </message>
  <message>
   <source>Splits the selected sub-surface along a wire or sketch that is also selected; a closed one cuts a piece out; without one, in the middle</source>
   <translation>Zerteilt die ausgewählte Teilfläche entlang eines mit ausgewählten Linienzugs oder einer Skizze; geschlossene schneiden ein Stück heraus; ohne solche in der Mitte</translation>
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
