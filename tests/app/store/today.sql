BEGIN TRANSACTION;
CREATE TABLE alembic_version (
	version_num VARCHAR(32) NOT NULL, 
	CONSTRAINT alembic_version_pkc PRIMARY KEY (version_num)
);
INSERT INTO "alembic_version" VALUES('0007');
CREATE TABLE document_steps (
	document_id VARCHAR NOT NULL, 
	number INTEGER NOT NULL, 
	label TEXT NOT NULL, 
	changed_at VARCHAR NOT NULL, 
	drawing TEXT NOT NULL, 
	PRIMARY KEY (document_id, number), 
	FOREIGN KEY(document_id) REFERENCES documents (id) ON DELETE CASCADE
);
INSERT INTO "document_steps" VALUES('t93vw8un',0,'','2026-11-29T07:59:53.462Z','{"name":"towel","title":"Towel","outline":[{"id":"v0","point":[0.0,0.0]},{"id":"v1","point":[0.4,0.0]},{"id":"v2","point":[0.4,0.3]},{"id":"v3","point":[0.0,0.3]}],"areal_density_kg_m2":0.2,"grip_radius_m":0.127,"folds":[],"placement":{"x_m":-0.7,"y_m":0.2,"yaw_rad":-1.5707963267948966},"scene":{"table":{"depth_m":1.6,"width_m":0.98,"height_m":0.79},"stations":{"front":{"x_m":-0.95,"y_m":0.0,"yaw_rad":0.0},"front_left":{"x_m":-0.1,"y_m":0.64,"yaw_rad":-1.5707963267948966},"left":{"x_m":0.45,"y_m":0.64,"yaw_rad":-1.5707963267948966},"front_right":{"x_m":-0.1,"y_m":-0.64,"yaw_rad":1.5707963267948966},"right":{"x_m":0.45,"y_m":-0.64,"yaw_rad":1.5707963267948966}},"torso_m":0.29,"friction":1.0,"support_angle_rad":0.08726646259971647,"approach_cone_rad":1.3089969389957472,"back_off_max_m":0.8,"edge_clear_m":0.03,"arm_motion_s":3.0,"grip_dwell_s":0.5,"base_speed_m_s":0.25,"base_turn_rad_s":0.5},"start_station":"front","comfort_radius_m":0.03,"robot":"pr2"}');
CREATE TABLE documents (
	id VARCHAR NOT NULL, 
	format INTEGER NOT NULL, 
	revision INTEGER NOT NULL, 
	version INTEGER NOT NULL, 
	changed_at VARCHAR NOT NULL, 
	opened_s DOUBLE, 
	title VARCHAR NOT NULL, 
	name VARCHAR NOT NULL, 
	first INTEGER NOT NULL, 
	now INTEGER NOT NULL, 
	problem TEXT, 
	start TEXT, 
	preview_version INTEGER, 
	preview_label VARCHAR, 
	preview TEXT, 
	PRIMARY KEY (id)
);
INSERT INTO "documents" VALUES('t93vw8un',3,0,1,'2026-11-29T07:59:53.462Z',NULL,'Towel','towel',0,0,NULL,NULL,NULL,NULL,NULL);
CREATE TABLE garments (
	name VARCHAR NOT NULL, 
	content TEXT NOT NULL, 
	PRIMARY KEY (name)
);
INSERT INTO "garments" VALUES('towel','{"name": "towel", "title": "Towel", "outline": [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]], "areal_density_kg_m2": 0.2, "folds": [], "grip_radius_m": 0.127, "placement": {"x_m": -0.7, "y_m": 0.2, "yaw_rad": -1.5707963267948966}}');
CREATE TABLE jobs (
	number INTEGER NOT NULL PRIMARY KEY AUTOINCREMENT, 
	id VARCHAR NOT NULL, 
	kind VARCHAR NOT NULL, 
	client VARCHAR NOT NULL, 
	status VARCHAR NOT NULL, 
	progress DOUBLE NOT NULL, 
	message TEXT NOT NULL, 
	created_s DOUBLE NOT NULL, 
	started_s DOUBLE, 
	ended_s DOUBLE, 
	begun INTEGER NOT NULL, 
	revision INTEGER NOT NULL, 
	body TEXT NOT NULL, 
	result TEXT, server BIGINT DEFAULT '0' NOT NULL, about TEXT DEFAULT '' NOT NULL, 
	UNIQUE (id)
);
CREATE TABLE plans (
	number INTEGER NOT NULL PRIMARY KEY AUTOINCREMENT, 
	id VARCHAR NOT NULL, 
	size INTEGER NOT NULL, 
	content BLOB NOT NULL, 
	UNIQUE (id)
);
CREATE TABLE robots (
	name VARCHAR NOT NULL, 
	digest VARCHAR NOT NULL, 
	content BLOB, 
	PRIMARY KEY (name)
);
CREATE TABLE shares (
	hash VARCHAR NOT NULL, 
	document_id VARCHAR NOT NULL, 
	created_s DOUBLE NOT NULL, 
	PRIMARY KEY (hash), 
	FOREIGN KEY(document_id) REFERENCES documents (id) ON DELETE CASCADE
);
CREATE TABLE studies (
	id VARCHAR NOT NULL, 
	title TEXT NOT NULL, 
	done_s DOUBLE NOT NULL, 
	content TEXT NOT NULL, 
	PRIMARY KEY (id)
);
CREATE TABLE study_files (
	study_id VARCHAR NOT NULL, 
	name VARCHAR NOT NULL, 
	content BLOB NOT NULL, 
	PRIMARY KEY (study_id, name), 
	FOREIGN KEY(study_id) REFERENCES studies (id) ON DELETE CASCADE
);
CREATE TABLE traces (
	number INTEGER NOT NULL PRIMARY KEY AUTOINCREMENT, 
	id VARCHAR NOT NULL, 
	size INTEGER NOT NULL, 
	content BLOB NOT NULL, 
	UNIQUE (id)
);
CREATE INDEX jobs_by_status ON jobs (status);
CREATE INDEX documents_by_change ON documents (changed_at, id);
CREATE INDEX ix_shares_document_id ON shares (document_id);
DELETE FROM "sqlite_sequence";
COMMIT;